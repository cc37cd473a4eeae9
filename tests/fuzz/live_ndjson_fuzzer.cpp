#include <algorithm>
#include <string_view>
#include <vector>

#include "tests/fuzz/require.hpp"
#include "traces/live/live_ndjson.hpp"
#include "traces/scene/avatar.hpp"

// Whatever comes on standard input, what is read of it can be recorded, and is the same in whatever pieces it comes.
// The first byte says how long the pieces are.

using vestige::fuzz::require;

namespace {

vestige::Avatar two_nodes() {
  vestige::Avatar avatar;
  avatar.nodes.resize(2);
  avatar.nodes[0].name = "a";
  avatar.nodes[1].name = "b";
  avatar.node_order = {0, 1};
  return avatar;
}

struct Reading {
  std::vector<std::uint64_t> indexes;
  std::vector<std::int64_t> times_ns;
  std::uint64_t malformed = 0;
  bool operator==(const Reading&) const = default;
};

Reading read(std::string_view text, std::size_t piece) {
  static const vestige::Avatar avatar = two_nodes();
  vestige::LiveNdjson lines(avatar);
  Reading reading;
  const auto take = [&](const vestige::TraceFrame& frame) {
    require(reading.indexes.empty() || frame.index > reading.indexes.back(), "numbers of frames grow");
    require(reading.times_ns.empty() || frame.time_ns >= reading.times_ns.back(), "time does not run back");
    require(frame.poses.front().nodes.size() == avatar.nodes.size(), "a pose fits the avatar");
    reading.indexes.push_back(frame.index);
    reading.times_ns.push_back(frame.time_ns);
  };
  for (; !text.empty(); text.remove_prefix(std::min(piece, text.size()))) lines.push(text.substr(0, piece), 5, take);
  lines.finish(5, take);
  reading.malformed = lines.malformed();
  return reading;
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's hook
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data + 1), size - 1);
  require(read(text, text.size() + 1) == read(text, std::size_t{data[0]} + 1), "the same is read in whatever pieces");
  return 0;
}
