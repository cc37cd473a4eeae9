// Writes a trace of the built-in avatar that is as large as asked, most of it holes on disk, so that memory can be
// looked at without filling one:
//
//     sparse_trace OUT.mcap 10e9
//
// Between chunks of frames stand chunks of zeros on a channel that nobody knows. Everything in it is as it should be,
// CRCs too: a reader that looked at the file's size, or kept a chunk, would show it.

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <stdexcept>

#include "traces/gltf/avatar_gltf.hpp"
#include "traces/mcap/stream_reader.hpp"
#include "traces/motion/animation_choice.hpp"
#include "traces/recording/sampled_scene.hpp"
#include "traces/scenarios/scenarios.hpp"
#include "traces/scene/builtin_avatar.hpp"
#include "traces/scene/colliders.hpp"
#include "traces/trace_file/definitions.hpp"
#include "traces/trace_file/mcap_output.hpp"
#include "traces/trace_file/trace_writer.hpp"

namespace {

using namespace vestige;

/// Writes whole pages of zeros by not writing them.
class SparseFile {
 public:
  explicit SparseFile(const std::filesystem::path& path)
      : descriptor_(::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666)) {
    if (descriptor_ < 0) throw std::runtime_error("cannot write there");
  }
  ~SparseFile() {
    if (::ftruncate(descriptor_, at_) != 0) std::cerr << "the file's end is missing\n";
    ::close(descriptor_);
  }
  SparseFile(const SparseFile&) = delete;
  SparseFile& operator=(const SparseFile&) = delete;

  void write(std::span<const std::byte> bytes) {
    constexpr std::size_t kPageBytes = 4096;
    while (!bytes.empty()) {
      const auto piece = bytes.first(std::min(kPageBytes, bytes.size()));
      const bool zero = std::all_of(piece.begin(), piece.end(), [](std::byte b) { return b == std::byte{0}; });
      if (!zero && ::pwrite(descriptor_, piece.data(), piece.size(), at_) != static_cast<ssize_t>(piece.size()))
        throw std::runtime_error("the disk is full");
      at_ += static_cast<off_t>(piece.size());
      bytes = bytes.subspan(piece.size());
    }
  }

 private:
  int descriptor_;
  off_t at_ = 0;
};

void write(const std::filesystem::path& path, double bytes) {
  constexpr std::uint64_t kFrames = 2000;
  constexpr std::size_t kFillBytes = std::size_t{4} << 20;
  const std::filesystem::path small = path.string() + ".small";
  const std::vector<std::byte> glb = builtin_avatar_glb();
  const Avatar avatar = parse_avatar_glb(glb, "builtin");
  {
    TraceWriter writer(small, {}, {{avatar, {.avatar_glb = glb}}}, {.overwrite = Overwrite::kAllow});
    const Animation* animation = find_animation(avatar, "");
    const auto colliders = find_scenario("swarm")->make(avatar, animation, {20, 1});
    const RecordingSettings settings{.rate_hz = 1000, .duration_s = static_cast<double>(kFrames) / 1000};
    record(
        [&](const TraceFrame& frame) {
          writer.write(frame);
          return true;
        },
        {{avatar, animation}}, *colliders, settings, [](double) { return true; });
    writer.finish();
  }
  SparseFile file(path);
  const mcap::FileSource source(small);
  McapOutput output([&](mcap::Bytes more) { file.write(more); }, "vestige", mcap::Compression::kNone,
                    gather_definitions(source));
  constexpr std::uint16_t kFill = 999;
  output.add(mcap::Channel{.id = kFill, .schema_id = 0, .topic = "/zeros", .message_encoding = "", .metadata = {}});
  output.write_definitions();
  const std::vector<std::byte> zeros(kFillBytes);
  const double fills_a_message = bytes / kFillBytes / (2 * kFrames);
  double due = 0;
  mcap::StreamReader reader(source);
  mcap::StreamRecord record;
  while (reader.next(record)) {
    if (record.opcode == mcap::Opcode::kMetadata) output.write(mcap::decode_metadata(record.content));
    if (record.opcode == mcap::Opcode::kAttachment) output.write(mcap::decode_attachment(record.content));
    if (record.opcode != mcap::Opcode::kMessage) continue;
    const mcap::Message message = mcap::decode_message(record.content);
    output.write(message);
    for (due += fills_a_message; due >= 1; due -= 1) {
      output.end_chunk();
      output.write(mcap::Message{.channel_id = kFill,
                                 .sequence = message.sequence,
                                 .log_time = message.log_time,
                                 .publish_time = message.log_time,
                                 .data = zeros});
      output.end_chunk();
    }
  }
  output.finish();
  std::filesystem::remove(small);
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 3) {
    std::cerr << "usage: sparse_trace OUT.mcap BYTES\n";
    return 2;
  }
  try {
    write(arguments[1], std::atof(arguments[2]));
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
  return 0;
}
