#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "traces/base/host_port.hpp"
#include "traces/live/vmc_state.hpp"
#include "traces/scene/avatar.hpp"
#include "traces/scene/trace.hpp"
#include "transport/latency_histogram.hpp"
#include "transport/sinks/datagram_sender.hpp"
#include "transport/vmc/collider_teller.hpp"
#include "transport/vmc/skin_difference.hpp"

namespace vestige {

/// A person of a trace whom a sender plays.
struct PlayedPerson {
  std::size_t person = 0;  ///< counted from 0
  const Avatar& avatar;
  std::string name;  ///< in messages: "trace.mcap", "trace.mcap, ann"
};

/// What a sender has done. Of several senders together: sums, and the largest deviation.
struct VmcStatistics {
  std::uint64_t sent = 0;            ///< frames whose datagrams were all passed to the system
  std::uint64_t unsent = 0;          ///< frames that were not sent, because there was no route to the host
  std::uint64_t links_lost = 0;      ///< number of times that the route was lost
  std::uint64_t poses_left_out = 0;  ///< poses that are not finite, or beyond 1e9 m
  SkinDifference::Bound deviation;   ///< most that a receiver's skin differs from the trace's
  LatencyHistogram written;          ///< from a frame's due time until its last byte was passed to the system

  VmcStatistics& operator+=(const VmcStatistics& other);
};

/// Plays a person of a trace to a program that takes the VMC protocol over UDP, as a VR program does: the pose in each
/// frame, and the colliders if asked to. Each frame is complete, so the next one corrects the loss of a datagram,
/// except of one with a teleport: that collider's path is then a motion. A missing receiver is not an error.
///
/// A copy of the receiver's state, of the same avatar, takes each pose that is sent. So the sender knows how far the
/// receiver's skin is from the trace's.
class VmcSender {
 public:
  using Clock = std::chrono::steady_clock;

  /// A skin that differs by more is told, in metres. Rounding to single precision stays below it near the origin.
  static constexpr double kToldDeviation_m = 1e-4;

  /// `collider_ids` are those of the whole trace, ascending; nothing: this sender sends no colliders. Calls `tell`,
  /// in the thread of the caller, once for each kind of thing that cannot be sent, and when the route is lost and back.
  /// Keeps a reference to the avatar. Throws `Error` as `vmc_skeleton` and `DatagramSender` do.
  VmcSender(const HostPort& place, const PlayedPerson& person,
            std::optional<std::span<const std::uint32_t>> collider_ids, std::function<void(const std::string&)> tell);

  const std::string& name() const { return out_.name(); }
  /// Whether the host reports that no program listens (`DatagramSender::is_refused`). What is sent for that changes
  /// nothing in a receiver.
  bool is_refused();

  /// The next frame follows no other: its colliders jump there.
  void begin_run() { follows_ = false; }
  /// Sends a frame. A pose that is missing stays as it was. Throws `Error` as `DatagramSender::send` does, but no
  /// `LinkLost`.
  void send(const TraceFrame& frame, double time_s, Clock::time_point due);
  /// Says that all colliders are gone, `kFinalTries` times.
  void finish();

  const VmcStatistics& statistics() const { return statistics_; }
  std::uint64_t bytes_sent() const { return out_.bytes_sent(); }
  std::uint64_t datagrams_sent() const { return out_.datagrams_sent(); }
  /// Number of colliders that were left out of some frame.
  std::size_t colliders_left_out() const { return colliders_ ? colliders_->left_out().size() : 0; }

 private:
  void append_pose(const TraceFrame& frame, std::vector<OscBytes>& out);
  void note_deviation(const TraceFrame& frame, const Pose& pose);
  /// Returns false if there is no route to the host.
  bool send_messages(std::span<const OscBytes> messages);

  PlayedPerson person_;
  std::function<void(const std::string&)> tell_;
  VmcSkeleton skeleton_;
  VmcState receiver_;
  SkinDifference difference_;
  std::optional<ColliderTeller> colliders_;
  DatagramSender out_;
  bool linked_ = true;
  bool follows_ = true;  ///< the first frame of all needs no teleport, since a new collider's path begins there
  VmcStatistics statistics_;
};

}  // namespace vestige
