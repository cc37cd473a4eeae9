#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "traces/live/live_ndjson.hpp"
#include "traces/live/udp_receiver.hpp"
#include "traces/live/vmc_state.hpp"
#include "traces/recording/recording_thread.hpp"

namespace vestige {

/// What somebody outside wants while a recording runs.
enum class LiveRequest : std::uint8_t { kGoOn, kSnapshot, kStop };

struct LiveSettings {
  double rate_hz = 1000;             ///< of frames made from a state
  std::optional<double> duration_s;  ///< nothing: until the source ends or `asked` says so
  std::function<LiveRequest()> asked = {};
};

struct LiveCounts {
  std::uint64_t frames = 0;      ///< handed on
  std::uint64_t late = 0;        ///< frames whose time had passed before they could be made, or that found no room
  std::uint64_t malformed = 0;   ///< lines or datagrams
  std::uint64_t overflowed = 0;  ///< datagrams that the system threw away
  bool lost_something() const { return late + malformed + overflowed > 0; }
};

/// Frames from lines of JSON on `descriptor`, as they come, until it ends. What is lost is counted in the trace too: a
/// line as a message of /pose and one of /colliders. Throws `Error`: reading or writing failed.
LiveCounts record_lines(int descriptor, LiveNdjson& lines, RecordingThread& out, const LiveSettings& settings);

/// Frames of the latest state, at absolute times of `rate_hz` since the first datagram that said something. A frame
/// whose time has passed by more than 20 ms is left out and counted as /pose and /colliders, datagrams as
/// `input`.
LiveCounts record_state(UdpReceiver& datagrams, VmcState& state, RecordingThread& out, const LiveSettings& settings);

}  // namespace vestige
