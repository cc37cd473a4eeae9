#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "analysis/run/detection_run.hpp"
#include "analysis/run/frame_pace.hpp"
#include "detector/detector.hpp"
#include "traces/timeline/timeline.hpp"
#include "traces/trace_file/trace_reader.hpp"

namespace vestige {

struct PlaybackResult : FramePace {
  /// What was found on one person.
  struct Person {
    std::uint64_t contacts = 0;
    std::uint64_t non_finite_frames = 0;  ///< counted by `FrameBuilder`
    std::uint64_t non_finite_segments = 0;
  };
  std::vector<Person> people = {};  ///< in the order in which they were given
};

/// The calls that a playback makes, all in the thread that runs `play`. `person` is a place in the list of people.
struct PlaybackCalls {
  using Clock = FrameCalls::Clock;

  /// Turns the contacts of a frame into what the vest is told. `frame` is null in a gap of the trace. The reference is
  /// valid until the next call.
  using Law = std::function<const ActuatorFrame&(double time_s, const ContactRow& row, const DetectorFrame* frame)>;

  /// Makes each person's law for one run through the trace.
  std::function<std::vector<Law>()> make_laws;
  /// Called before each frame, and repeatedly while the playback waits for one. Returns false to end the playback. May
  /// exchange the actuator map.
  std::function<bool(double share)> go_on;
  /// As in `FrameCalls`.
  std::function<void()> fell_behind;
  /// Called for each person after each frame, and during gaps, with what to tell the vest and when that was due.
  std::function<void(std::size_t person, const ActuatorFrame&, Clock::time_point due)> take;
};

/// Replays the people of `trace` through their detectors, as `play_frames` paces it. All frames are replayed, however
/// late, since contacts depend on the frame before. In a gap of the trace, the law continues without contacts, so that
/// no actuator is held on. When the playback loops, the times that are handed on continue to rise.
PlaybackResult play(TraceReader& trace, std::span<const DetectedPerson> people, const PlaybackOptions& options,
                    const PlaybackCalls& calls);

}  // namespace vestige
