// How fast traces are written and read: 20 nodes, 100 colliders. Prints frames a second; no test, since it depends on
// the machine.

#include <fmt/format.h>

#include <chrono>

#include "tests/traces/trace_fixture.hpp"

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

void measure(const std::filesystem::path& path, vestige::Compression compression, const char* name) {
  using namespace vestige;
  constexpr std::size_t kNodes = 20;
  constexpr std::size_t kColliders = 100;
  constexpr std::uint64_t kFrames = 50'000;
  const auto glb = test::skeleton_glb(kNodes);
  std::vector<TraceFrame> frames;
  constexpr std::uint64_t kDistinct = 1000;
  for (std::uint64_t i = 0; i < kDistinct; ++i) frames.push_back(test::frame(i, kNodes, kColliders));

  auto start = Clock::now();
  {
    TraceWriter writer(path, {}, test::skeleton(kNodes), {.avatar_glb = glb},
                       {.overwrite = Overwrite::kAllow, .compression = compression});
    for (std::uint64_t i = 0; i < kFrames; ++i) {
      TraceFrame& frame = frames[i % kDistinct];
      frame.index = i;
      frame.time_ns = static_cast<std::int64_t>(i) * 1'000'000;
      writer.write(frame);
    }
    writer.finish();
  }
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
}

}  // namespace

int main() {
  const auto path = std::filesystem::temp_directory_path() / "vestige-trace-benchmark.mcap";
  measure(path, vestige::Compression::kNone, "none");
  measure(path, vestige::Compression::kLz4, "lz4");
  measure(path, vestige::Compression::kZstd, "zstd");
  std::filesystem::remove(path);
}
