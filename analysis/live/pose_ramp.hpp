#pragma once

#include <chrono>

#include "traces/scene/pose.hpp"

namespace vestige {

/// Returns the pose at a share of the way from `a` (0) to `b` (1). Both ends are returned to the bit. Rotations take
/// the shorter arc at a constant speed (Shoemake 1985, Animating rotation with quaternion curves). Precondition: both
/// have as many nodes.
Pose pose_between(const Pose& a, const Pose& b, double share);

/// Leads from pose to pose without jumps, where poses come slower than frames: each new pose is reached only when the
/// next one is expected, so what is shown is one pose late.
class PoseRamp {
 public:
  using Clock = std::chrono::steady_clock;

  /// From `from` on, leads from the pose shown at that time to `pose`, which it reaches after `length`. A length of 0
  /// shows `pose` at once. The first pose is shown at once, too. Precondition: `from` never decreases.
  void lead_to(const Pose& pose, Clock::time_point from, Clock::duration length);

  /// Returns the pose at a time. Precondition: `lead_to` was called.
  Pose at(Clock::time_point time) const;

  /// Returns how far the pose shown at a time lags behind: the length of the way to the newest pose while it is under
  /// way, and 0 once the newest pose is shown.
  Clock::duration delay_at(Clock::time_point time) const;

 private:
  Pose from_pose_;
  Pose to_pose_;
  Clock::time_point from_;
  Clock::duration length_ = {};
};

}  // namespace vestige
