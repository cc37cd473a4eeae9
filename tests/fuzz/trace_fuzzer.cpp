#include <cstring>

#include "tests/fuzz/require.hpp"
#include "traces/base/error.hpp"
#include "traces/repair/trace_check.hpp"
#include "traces/repair/trace_summary.hpp"
#include "traces/trace_file/trace_reader.hpp"

// Whatever bytes a trace holds, reading it ends in an error that says something, or in frames that keep what
// trace_reader.hpp promises. Summarising and checking it end, too.

using vestige::fuzz::require;

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's hook
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace vestige;  // NOLINT(google-build-using-namespace)
  const std::span<const std::byte> bytes(reinterpret_cast<const std::byte*>(data), size);
  const auto path = fuzz::in_a_file(bytes);
  try {
    TraceReader reader(path);
    TraceFrame frame;
    std::uint64_t frames = 0;
    std::uint64_t last_index = 0;
    std::int64_t last_ns = 0;
    while (reader.next(frame)) {
      require(frames == 0 || frame.index > last_index, "numbers of frames grow");
      require(frame.time_ns >= last_ns, "time does not run back");
      require(frame.poses.front().nodes.size() == reader.people().front().node_names.size(), "a pose fits the avatar");
      last_index = frame.index;
      last_ns = frame.time_ns;
      ++frames;
    }
    require(reader.frame_count() == frames, "frames are counted as they are read");
  } catch (const Error& error) {
    require(std::strlen(error.what()) > 0, "errors say something");
  }
  try {
    const McapSummary summary = summarise_mcap(path);
    require(summary.warnings.size() <= mcap::ProblemList::kMostKept + 1, "warnings are limited");
  } catch (const Error& error) {
    require(std::strlen(error.what()) > 0, "errors say something");
  }
  try {
    const mcap::MemorySource source(bytes);
    static_cast<void>(check_trace(source, [](double) { return true; }));
  } catch (const Error& error) {
    require(std::strlen(error.what()) > 0, "errors say something");
  }
  return 0;
}
