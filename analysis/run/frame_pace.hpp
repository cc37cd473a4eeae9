#pragma once

#include <chrono>
#include <cstdint>
#include <functional>

#include "traces/scene/trace.hpp"
#include "traces/trace_file/trace_reader.hpp"

namespace vestige {

struct PlaybackOptions {
  double rate = 1;  ///< trace seconds per second
  bool loop = false;
};

/// How well a playback kept to its times.
struct FramePace {
  std::uint64_t frames = 0;
  std::uint64_t loops = 0;             ///< complete runs through the trace
  std::uint64_t missed_deadlines = 0;  ///< frames that were not done when the next frame was due
  double most_late_s = 0;              ///< largest delay between a frame's due time and its start
  double duration_s = 0;               ///< wall-clock time

  /// Returns whether a frame began more than a second late: the work is too slow, or the process was stopped.
  bool fell_behind() const { return most_late_s > 1; }
};

/// The calls that `play_frames` makes, all in the thread that runs it. Those that say "may be empty" need not be set.
struct FrameCalls {
  using Clock = std::chrono::steady_clock;
  enum class AtEnd : std::uint8_t {
    kReturn,       ///< returns after the last frame
    kHoldTheLast,  ///< returns when the frame after the last one would be due
  };

  AtEnd at_end = AtEnd::kReturn;
  std::function<void()> begin_run = {};  ///< called before each run through the trace; may be empty
  /// Called before each frame, and repeatedly while the playback waits for one. Returns false to end the playback.
  std::function<bool(double share)> go_on;
  /// Called repeatedly in a gap of the trace, with the trace's time now; may be empty.
  std::function<void(double time_s, Clock::time_point now)> gap = {};
  /// Called once, as soon as `FramePace::fell_behind` is true.
  std::function<void()> fell_behind;
  /// Called for each frame. `time_s` rises also from run to run.
  std::function<void(const TraceFrame&, double time_s, Clock::time_point due)> take;
};

/// Hands on the frames of `trace` at the trace's own pace. The first frame is due at once. Deadlines are absolute, so a
/// late frame does not delay the frames that follow. All frames are handed on, however late.
FramePace play_frames(TraceReader& trace, const PlaybackOptions& options, const FrameCalls& calls);

}  // namespace vestige
