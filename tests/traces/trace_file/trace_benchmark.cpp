// How fast traces are written and read: 20 nodes, 100 colliders. Prints frames a second, and what share of that time
// the CRCs take; no test, since it depends on the machine.

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "tests/traces/trace_file/trace_fixture.hpp"
#include "traces/files/input_file.hpp"
#include "traces/mcap/chunk_expander.hpp"
#include "traces/mcap/crc32.hpp"
#include "traces/mcap/decode.hpp"
#include "traces/mcap/record_walker.hpp"

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

constexpr std::size_t kNodes = 20;
constexpr std::size_t kColliders = 100;
constexpr std::uint64_t kFrames = 50'000;

void write(const std::filesystem::path& path, vestige::Compression compression,
           std::vector<vestige::TraceFrame>& frames) {
  using namespace vestige;
  const auto glb = test::skeleton_glb(kNodes);
  TraceWriter writer(path, {}, {{test::skeleton(kNodes), {.avatar_glb = glb}}},
                     {.overwrite = Overwrite::kAllow, .compression = compression});
  for (std::uint64_t i = 0; i < kFrames; ++i) {
    TraceFrame& frame = frames[i % frames.size()];
    frame.index = i;
    frame.time_ns = static_cast<std::int64_t>(i) * 1'000'000;
    writer.write(frame);
  }
  writer.finish();
}

double read(const std::filesystem::path& path) {
  vestige::TraceReader reader(path);
  vestige::TraceFrame frame;
  const auto start = Clock::now();
  while (reader.next(frame)) continue;
  return seconds_since(start);
}

/// The bytes that writing checksums: the file itself, and its chunks before they are compressed, which reading does
/// too.
struct Checksummed {
  std::vector<std::byte> file;
  std::vector<std::byte> chunks;
};

Checksummed checksummed(const std::filesystem::path& path) {
  using namespace vestige;
  Checksummed bytes{.file = read_file(path), .chunks = {}};
  const mcap::MemorySource source(bytes.file);
  mcap::RecordWalker walker(source);
  mcap::RecordPlace place;
  mcap::RawBuffer content;
  mcap::RawBuffer expanded;
  while (walker.next(place)) {
    if (place.opcode != mcap::Opcode::kChunk) continue;
    const auto records = mcap::expand_chunk(mcap::decode_chunk(walker.content(place, content)), expanded);
    bytes.chunks.insert(bytes.chunks.end(), records.begin(), records.end());
  }
  return bytes;
}

volatile std::uint32_t checksum_seen = 0;  // so that computing it is not left out

double checksum(std::span<const std::byte> bytes) {
  constexpr std::size_t kChunkBytes = std::size_t{1} << 20;
  const auto start = Clock::now();
  for (; !bytes.empty(); bytes = bytes.subspan(std::min(kChunkBytes, bytes.size())))
    checksum_seen = vestige::mcap::crc32(bytes.first(std::min(kChunkBytes, bytes.size())));
  return seconds_since(start);
}

/// Writing, reading and the CRCs alone take turns, so that all of them see the same machine. What they would take
/// without CRCs is the difference.
void measure_crc(const std::filesystem::path& path, vestige::Compression compression, const char* name,
                 std::vector<vestige::TraceFrame>& frames) {
  write(path, compression, frames);
  const Checksummed bytes = checksummed(path);
  double write_s = 1e9;
  double read_s = 1e9;
  double file_crc_s = 1e9;
  double chunk_crc_s = 1e9;
  for (int round = 0; round < 7; ++round) {
    auto start = Clock::now();
    write(path, compression, frames);
    write_s = std::min(write_s, seconds_since(start));
    file_crc_s = std::min(file_crc_s, checksum(bytes.file));
    read_s = std::min(read_s, read(path));
    chunk_crc_s = std::min(chunk_crc_s, checksum(bytes.chunks));
  }
  const double write_crc_s = file_crc_s + chunk_crc_s;
  fmt::print("{:5} CRCs take {:4.1f} % more of writing and {:4.1f} % more of reading than without\n", name,
             100 * write_crc_s / (write_s - write_crc_s), 100 * chunk_crc_s / (read_s - chunk_crc_s));
}

void measure(const std::filesystem::path& path, vestige::Compression compression, const char* name) {
  using namespace vestige;
  std::vector<TraceFrame> frames;
  constexpr std::uint64_t kDistinct = 1000;
  for (std::uint64_t i = 0; i < kDistinct; ++i) frames.push_back(test::frame(i, kNodes, kColliders));

  auto start = Clock::now();
  write(path, compression, frames);
  const double write_s = seconds_since(start);

  TraceReader reader(path);
  TraceFrame frame;
  double best_read_s = 1e9;
  for (int run = 0; run < 3; ++run) {
    reader.rewind();
    start = Clock::now();
    while (reader.next(frame)) continue;
    best_read_s = std::min(best_read_s, seconds_since(start));
  }
  start = Clock::now();
  const std::uint64_t counted = reader.frame_count();
  fmt::print("{:5} {:6.1f} MB  write {:8.0f} frames/s  read {:8.0f} frames/s  count {:8.0f} frames/s\n", name,
             static_cast<double>(std::filesystem::file_size(path)) / 1e6, kFrames / write_s, kFrames / best_read_s,
             static_cast<double>(counted) / seconds_since(start));
  measure_crc(path, compression, name, frames);
}

}  // namespace

int main() {
  const auto path = std::filesystem::temp_directory_path() / "vestige-trace-benchmark.mcap";
  measure(path, vestige::Compression::kNone, "none");
  measure(path, vestige::Compression::kLz4, "lz4");
  measure(path, vestige::Compression::kZstd, "zstd");
  std::filesystem::remove(path);
}
