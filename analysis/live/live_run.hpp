#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/live/live_columns.hpp"
#include "analysis/live/live_input.hpp"
#include "analysis/run/felt_frames.hpp"
#include "traces/recording/frame_ring.hpp"
#include "traces/scene/trace.hpp"

namespace vestige {

struct LiveOptions {
  /// Frames are made at absolute times of this rate since the first one. Nothing: each whole frame that came in is one.
  std::optional<double> rate_hz = {};
  /// If no whole frame came for this time, all actuators are switched off.
  std::chrono::milliseconds ttl{200};
  std::optional<double> duration_s = {};  ///< since the first frame; nothing: until the input ends or is stopped
};

/// When a frame was where.
struct LiveMoments {
  using Clock = LiveFrame::Clock;

  Clock::time_point arrived;  ///< the newest of what it shows; where nothing new came: when the frame was due
  Clock::time_point decoded;
  Clock::time_point detected;
  double pose_delay_s = 0;           ///< as in `LiveFrame`
  std::optional<double> interval_s;  ///< since the frame before was detected; nothing for a first one after silence
};

/// The calls that a live run makes, all in the thread that runs it. Laws are made anew whenever the input was silent.
struct LiveCalls : FeltCalls {
  /// Called at least every 20 ms. Returns false to end the run. May exchange the actuator map.
  std::function<bool()> go_on = {};
  /// Called for each frame, after what it makes felt was handed on.
  std::function<void(const LiveMoments&)> note = {};
  /// Called for each frame, last. `notes` came or were counted since the frame before. May be empty.
  std::function<void(const TraceFrame& frame, std::vector<RecordingNote> notes)> record = {};
  /// Called with sentences about what happens.
  std::function<void(const std::string&)> tell = {};
};

struct LiveResult {
  std::uint64_t frames = 0;            ///< detected
  std::uint64_t superseded = 0;        ///< `LiveInput::superseded`; 0 with a rate
  std::uint64_t missed_deadlines = 0;  ///< frames left out since the next one was due already; only with a rate
  std::uint64_t silences = 0;          ///< how often no whole frame came for `LiveOptions::ttl`
  std::uint64_t colliders = 0;         ///< `LiveColumns::seen`
  double duration_s = 0;               ///< from the first frame to the end
  LiveLosses losses;
  std::vector<RecordingNote> notes;          ///< for the recording, that came or were counted since the last frame
  std::vector<FeltPerson> people;            ///< in the order in which they were given
  std::vector<std::string> contacts_hashes;  ///< of each of them, by `ContactsHash`
};

/// Finds contacts in live input, and hands on what is felt, until `calls.go_on` returns false or the input has ended.
///
/// - A frame is detected as soon as it is whole, or at its time (`LiveOptions::rate_hz`). There is no queue: of all
/// that
///   has arrived, the newest whole frame counts. Frames are numbered without gaps, since each segment leads from one
///   detected frame to the next.
/// - A frame's time is when it had arrived, since the first one.
/// - Nothing moves in a frame that no motion leads to (`LiveFrame::begins`), and in the first one after silence: all of
///   its colliders are teleported. So it tests nothing, and neither does its recording.
/// - If no frame comes for 0.2 s, laws go on without contacts, as in a gap of a trace.
/// - In silence, the laws are made anew, so that nothing stays on by a law's hold, and go on without contacts. So is
/// the
///   law of a person who alone is silent (`LiveFrame::is_silent`).
LiveResult run_live(LiveInput& input, std::span<const DetectedPerson> people, const LiveOptions& options,
                    const LiveCalls& calls);

}  // namespace vestige
