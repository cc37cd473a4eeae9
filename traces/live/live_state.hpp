#pragma once

#include <chrono>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <set>
#include <span>

#include "traces/live/udp_receiver.hpp"
#include "traces/live/vmc_state.hpp"
#include "traces/recording/frame_ring.hpp"
#include "traces/scene/avatar.hpp"
#include "traces/scene/stance.hpp"
#include "traces/scene/trace.hpp"

namespace vestige {

/// What a VR program sends (`VmcState`), as whole frames: a frame that was told in part is not shown.
///
/// A datagram that ends a frame (/VMC/Ext/OK) makes all whole that came before. So does a datagram without a message of
/// the pose, unless a pose was begun and has not ended: colliders may come faster than poses. If a pose was begun and
/// no more of it came for 10 ms, the next datagram ends it: its end was lost. If the sender of the pose has not said an
/// end by then, or says none for 100 ms, each of its datagrams is whole, until it says one.
class LiveState {
 public:
  using Clock = Datagram::Clock;

  /// kAny: whoever sends to the port is heard. kOneAtATime: of poses, and of colliders, only the first sender is heard,
  /// until it has been silent for a second. One program may send poses and another colliders.
  enum class Senders : std::uint8_t { kAny, kOneAtATime };

  /// As `VmcState`.
  LiveState(const Avatar& avatar, const glm::dvec3& origin_m, const Stance& stance = {},
            Senders senders = Senders::kAny);

  /// Takes a datagram. Returns whether there is a new whole frame.
  bool take(const Datagram& datagram);

  /// Returns in `frame` the newest whole frame, with one pose and by ascending ids, without number and time. Reports
  /// each teleport once. Before the first whole frame, the avatar is in its rest pose.
  void show(TraceFrame& frame);
  /// Adds teleports that were shown and not passed on, for the next frame.
  void mark_teleported(std::span<const std::uint32_t> ids);

  std::uint64_t frames() const { return frames_; }                  ///< whole ones so far
  Clock::time_point arrived() const { return arrived_; }            ///< when the newest one had arrived
  std::uint64_t poses() const { return poses_; }                    ///< whole frames so far that told the pose
  Clock::time_point pose_arrived() const { return pose_arrived_; }  ///< when the newest of these had arrived
  /// If colliders come from another program than poses, and that one has been silent since `time`, its colliders are
  /// gone. Returns whether they were taken away now.
  bool remove_colliders_silent_since(Clock::time_point time);
  /// All colliders are gone.
  void remove_colliders();
  /// Returns once whether no motion leads to the newest frame: it is the first one with a pose, or the first one that
  /// is known to be whole.
  bool take_beginning();

  /// Datagrams left out because of `Senders::kOneAtATime`, and who sent the first of them.
  std::uint64_t left_out() const { return left_out_; }
  const std::optional<UdpAddress>& stranger() const { return stranger_; }

  /// What was taken, the markers, and the faults.
  const VmcState& vmc() const { return state_; }
  void forget_markers() { state_.forget_markers(); }

 private:
  struct Speaker {
    std::optional<UdpAddress> address;
    Clock::time_point heard;

    /// Whether a datagram is of whoever is heard, or nobody is.
    bool admits(const Datagram& datagram) const;
    void hear(const Datagram& datagram);
  };

  bool admits(const VmcContent& content, const Datagram& datagram);
  /// Whether all that was told is whole with a datagram of this content.
  bool completes(const VmcContent& content) const;
  /// Takes a part as whole if its end does not come.
  void end_old_part(Clock::time_point now);
  /// Before a part of a frame is told: keeps what is whole.
  void begin_part(const VmcContent& content, Clock::time_point arrived);
  void note_whole(Clock::time_point arrived);

  VmcState state_;
  Senders senders_;
  Speaker of_pose_;
  Speaker of_colliders_;
  /// Whether the sender of the pose says where frames end.
  enum class Ends : std::uint8_t { kUnknown, kTold, kNeverTold };
  Ends ends_ = Ends::kUnknown;
  bool is_told_in_part_ = false;  ///< the state holds more than is whole, which is in `kept_`
  bool has_new_pose_ = false;     ///< the state holds a pose that is newer than the newest whole one
  bool begins_ = false;           ///< for `take_beginning`
  Clock::time_point part_begun_;  ///< when the first datagram came of what is told in part
  Clock::time_point part_told_;   ///< when the newest datagram with a pose came, while something is told in part
  TraceFrame kept_;
  std::set<std::uint32_t> teleported_;  ///< of whole frames, not shown yet
  std::uint64_t frames_ = 0;
  Clock::time_point arrived_;
  std::uint64_t poses_ = 0;
  Clock::time_point pose_arrived_;
  std::uint64_t left_out_ = 0;
  std::optional<UdpAddress> stranger_;
};

}  // namespace vestige
