#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "traces/recording/frame_ring.hpp"
#include "traces/scene/trace.hpp"

namespace vestige {

/// A frame that came in live.
struct LiveFrame {
  using Clock = std::chrono::steady_clock;

  TraceFrame frame;  ///< without number and time
  /// When the newest of what it shows had arrived: of a datagram by the system's time stamp, of a line when it was
  /// read.
  Clock::time_point arrived;
  Clock::time_point decoded;  ///< when it could be shown
  double pose_delay_s = 0;    ///< how late it shows the newest pose, by `PoseShown::kInterpolate`
  bool begins = false;        ///< no motion leads to it from the frame before, of poses or colliders
  /// By person: whether only others go on, so that this person's pose is an old one. Empty: nobody's.
  std::vector<bool> is_silent;
};

/// What was left out, in datagrams or lines.
struct LiveLosses {
  std::uint64_t malformed = 0;   ///< could not be read
  std::uint64_t overflowed = 0;  ///< the system discarded them, since they were not read in time
  std::uint64_t strangers = 0;   ///< came from a second sender to a port
  bool ids_clash = false;        ///< colliders of one id came to several ports; only one port's count

  std::uint64_t total() const { return malformed + overflowed + strangers; }
};

/// Live input as whole frames. There is no queue: `receive` takes all that has arrived, and only the newest whole frame
/// can be shown.
class LiveInput {
 public:
  using Clock = LiveFrame::Clock;
  static constexpr std::chrono::milliseconds kLongestTurn{5};

  LiveInput() = default;
  virtual ~LiveInput() = default;
  LiveInput(const LiveInput&) = delete;
  LiveInput& operator=(const LiveInput&) = delete;

  /// For `poll`: readable if something has arrived.
  virtual std::vector<int> descriptors() const = 0;
  /// Takes what has arrived, without waiting, for at most `kLongestTurn`: in a flood there is always more. Throws
  /// `Error` if reading failed.
  virtual void receive() = 0;
  /// Number of whole frames so far.
  virtual std::uint64_t frames() const = 0;
  /// Whether every person has sent a whole frame. Before, there is nothing to show.
  virtual bool has_begun() const = 0;
  /// Whether nothing more can come.
  virtual bool has_ended() const = 0;
  /// When the newest whole frame had arrived.
  virtual Clock::time_point arrived() const = 0;
  /// Returns the newest whole frame, as it is at `time`. Precondition: `has_begun`.
  virtual void show(Clock::time_point time, LiveFrame& out) = 0;
  /// Number of whole frames that a newer one of the same sender replaced before they were shown.
  virtual std::uint64_t superseded() const = 0;
  /// Returns the markers since the last call.
  virtual std::vector<RecordingNote> take_markers() = 0;
  /// Returns sentences about faults since the last call, the first few of each kind.
  virtual std::vector<std::string> take_problems() = 0;
  virtual LiveLosses losses() const = 0;
};

}  // namespace vestige
