#pragma once

#include <functional>
#include <span>
#include <vector>

#include "analysis/run/felt_frames.hpp"
#include "analysis/run/frame_pace.hpp"
#include "traces/trace_file/trace_reader.hpp"

namespace vestige {

struct PlaybackResult : FramePace {
  std::vector<FeltPerson> people = {};  ///< in the order in which they were given
};

/// The calls that a playback makes, all in the thread that runs `play`. Laws are made for each run through the trace.
struct PlaybackCalls : FeltCalls {
  /// Called before each frame, and repeatedly while the playback waits for one. Returns false to end the playback. May
  /// exchange the actuator map.
  std::function<bool(double share)> go_on = {};
  /// As in `FrameCalls`.
  std::function<void()> fell_behind = {};
};

/// Replays the people of `trace` through their detectors, as `play_frames` paces it. All frames are replayed, however
/// late, since contacts depend on the frame before. In a gap of the trace, the law continues without contacts, so that
/// no actuator is held on. When the playback loops, the times that are handed on continue to rise.
PlaybackResult play(TraceReader& trace, std::span<const DetectedPerson> people, const PlaybackOptions& options,
                    const PlaybackCalls& calls);

}  // namespace vestige
