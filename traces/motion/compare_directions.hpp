#pragma once

#include <array>
#include <cstddef>
#include <glm/mat3x3.hpp>
#include <string>
#include <vector>

#include "traces/motion/bvh.hpp"
#include "traces/motion/retarget.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige {

/// A direction of the body that motion and avatar must have in common.
struct ComparedDirection {
  std::string what;
  std::array<std::size_t, 2> joints = {};  ///< of the motion: from, to
  std::array<std::size_t, 2> nodes = {};   ///< of the avatar: from, to
  double tolerance_deg = 0;                ///< more is a deviation
};

/// Plays the animation and compares directions with the motion in every frame. `to_avatar` rotates the motion's axes to
/// the avatar's. Returns those that differ by more than their tolerance. Frames in which joints are closer together
/// than a tenth of their largest distance tell no direction and do not count.
std::vector<Deviation> compare_directions(const BvhMotion& motion, const Avatar& avatar, const Animation& animation,
                                          const glm::dmat3& to_avatar,
                                          const std::vector<ComparedDirection>& directions);

}  // namespace vestige
