#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "traces/live/live_ndjson.hpp"
#include "traces/live/live_state.hpp"
#include "traces/live/udp_receiver.hpp"
#include "traces/recording/recording_thread.hpp"

namespace vestige {

/// A request from outside while a recording runs.
enum class LiveRequest : std::uint8_t { kGoOn, kSnapshot, kStop };

struct LiveSettings {
  double rate_hz = 1000;             ///< rate of frames made from a state
  std::optional<double> duration_s;  ///< nothing: until the source ends or `asked` stops the recording
  std::function<LiveRequest()> asked = {};
  std::function<void(TraceFrame&)> complete = {};  ///< adds what no source sends to each frame; may be empty
};

/// Where the motion of a person comes from, and colliders.
struct LiveSource {
  UdpReceiver& datagrams;
  LiveState& state;
};

struct LiveCounts {
  std::uint64_t frames = 0;      ///< frames passed on
  std::uint64_t late = 0;        ///< frames that were too late, or for which there was no room
  std::uint64_t malformed = 0;   ///< malformed lines or datagrams
  std::uint64_t overflowed = 0;  ///< datagrams that the system discarded
  bool ids_clash = false;        ///< several sources sent colliders of one id, and all but one were left out
  bool lost_input() const { return late + malformed + overflowed > 0; }
  bool lost_something() const { return lost_input() || ids_clash; }
};

/// Records frames from lines of JSON on `descriptor`, as they arrive, until it ends. Losses are also counted in the
/// trace: a lost line as one message of /pose and one of /colliders. Throws `Error` if reading or writing failed.
LiveCounts record_lines(int descriptor, LiveNdjson& lines, RecordingThread& out, const LiveSettings& settings);

/// Records the newest whole frames of all sources, joined by a `LiveScene`, at absolute times of `rate_hz` since the
/// first one. Each source is a person's, in their order. A frame whose time has passed by more than 20 ms is left out.
/// The trace counts lost frames as /pose and /colliders, and lost datagrams as `input`.
LiveCounts record_states(std::span<const LiveSource> sources, RecordingThread& out, const LiveSettings& settings);

}  // namespace vestige
