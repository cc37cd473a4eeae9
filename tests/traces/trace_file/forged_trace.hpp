#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "tests/traces/mcap/mcap_files.hpp"
#include "tests/traces/trace_file/trace_fixture.hpp"
#include "traces/mcap/writer.hpp"
#include "traces/trace_file/trace_format.hpp"
#include "traces/trace_file/trace_messages.hpp"

namespace vestige::test {

/// A trace written record by record, so that it may say what no recorder of ours would.
class ForgedTrace {
 public:
  explicit ForgedTrace(const mcap::WriterOptions& options = {})
      : writer_(into(bytes_), {.profile = "vestige", .library = "forged"}, options) {
    const std::vector<std::byte> glb = skeleton_glb(kNodes);
    writer_.write(mcap::Metadata{.name = "session", .metadata = {{"format_version", "1"}}});
    writer_.write(mcap::Attachment{.name = "avatar.glb", .media_type = "", .data = glb});
    for (const trace_format::Stream stream :
         {trace_format::Stream::kPose, trace_format::Stream::kColliders, trace_format::Stream::kEvents}) {
      mcap::Channel channel = trace_format::channel_of(stream);
      if (stream == trace_format::Stream::kPose) channel.metadata["nodes"] = R"(["a","b","c"])";
      writer_.write(trace_format::schema_of(stream));
      writer_.write(channel);
    }
  }

  void frame(std::uint32_t sequence, std::uint64_t time_ns) {
    pose(sequence, time_ns);
    colliders(sequence, time_ns, {});
  }
  void pose(std::uint32_t sequence, std::uint64_t time_ns, std::size_t nodes = kNodes) {
    message(1, sequence, time_ns,
            encoder_.pose(static_cast<std::int64_t>(time_ns), test::frame(0, nodes, 0).poses.front()));
  }
  void colliders(std::uint32_t sequence, std::uint64_t time_ns, const std::vector<ColliderSample>& colliders) {
    message(2, sequence, time_ns, encoder_.colliders(static_cast<std::int64_t>(time_ns), colliders));
  }
  void dropped(std::uint32_t sequence, std::uint64_t count, std::string_view topic = "/pose") {
    message(3, sequence, sequence, encoder_.event({.kind = "dropped", .count = count, .text = topic}));
  }
  void message(std::uint16_t channel, std::uint32_t sequence, std::uint64_t time_ns, mcap::Bytes data) {
    writer_.write(mcap::Message{
        .channel_id = channel, .sequence = sequence, .log_time = time_ns, .publish_time = time_ns, .data = data});
  }
  void end_chunk() { writer_.close_chunk(); }
  const std::vector<std::byte>& finished() {
    writer_.finish();
    return bytes_;
  }

 private:
  std::vector<std::byte> bytes_;
  mcap::Writer writer_;
  MessageEncoder encoder_;
};

}  // namespace vestige::test
