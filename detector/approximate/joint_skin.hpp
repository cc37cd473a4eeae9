#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "detector/decision.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige {

/// The skin that one joint moves: the triangles in which the joint has the largest sum of weights.
struct JointSkin {
  std::size_t palette = 0;               ///< entry of `Avatar::palette`
  std::vector<std::uint32_t> triangles;  ///< ascending
  /// One for each triangle: its corners in the rest pose, in the joint's bind space. The joint's skinning matrix of the
  /// rest pose moves them to where the skin lies at rest.
  std::vector<Corners> corners;
};

/// Returns the skin of every joint that moves any, by ascending palette entry. Each triangle belongs to one joint. A
/// joint that is scaled to nothing at rest has no skin.
std::vector<JointSkin> skin_by_joint(const Avatar& avatar);

}  // namespace vestige
