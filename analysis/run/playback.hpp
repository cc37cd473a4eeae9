#pragma once

#include <chrono>
#include <cstdint>
#include <functional>

#include "detector/detector.hpp"
#include "traces/timeline/timeline.hpp"
#include "traces/trace_file/trace_reader.hpp"

namespace vestige {

struct PlaybackOptions {
  double rate = 1;  ///< trace seconds per second
  bool loop = false;
};

struct PlaybackResult {
  std::uint64_t frames = 0;
  std::uint64_t contacts = 0;
  std::uint64_t loops = 0;              ///< complete runs through the trace
  std::uint64_t missed_deadlines = 0;   ///< frames that were not done when the next one was due
  std::uint64_t non_finite_frames = 0;  ///< as `FrameBuilder` counts them
  std::uint64_t non_finite_segments = 0;
  double most_late_s = 0;  ///< between when a frame was due and when it was begun
  double duration_s = 0;   ///< by the clock on the wall

  /// Whether a frame began a second too late: the detector cannot keep up, or the process was stopped.
  bool fell_behind() const { return most_late_s > 1; }
};

/// What a playback tells and asks, in its own thread.
struct PlaybackCalls {
  using Clock = std::chrono::steady_clock;

  /// What the contacts of a frame mean to the vest. The reference stays good until the next call.
  using Law = std::function<const ActuatorFrame&(double time_s, const ContactRow& row)>;

  /// Makes the law for one run through the trace.
  std::function<Law()> make_law;
  /// Before each frame: false ends the playback. May exchange the actuator map.
  std::function<bool(double share)> go_on;
  /// Once, as soon as `PlaybackResult::fell_behind`.
  std::function<void()> fell_behind;
  /// After each frame: what the vest is to be told, and when the frame was due.
  std::function<void(const ActuatorFrame&, Clock::time_point due)> take;
};

/// Replays `trace` through `detector` at the trace's own pace, on absolute deadlines: a late frame delays none of those
/// that follow. The first is due at once. No frame is left out, however late, since contacts depend on the one before.
/// Where the trace leaves a gap, the law goes on without contacts, so that nothing is held on. Where it begins anew,
/// the times of what is handed on go on.
PlaybackResult play(TraceReader& trace, const Avatar& avatar, Detector& detector, const PlaybackOptions& options,
                    const PlaybackCalls& calls);

}  // namespace vestige
