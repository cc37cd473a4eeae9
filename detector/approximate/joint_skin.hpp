#pragma once

#include <cstddef>
#include <vector>

#include "detector/approximate/skin_spots.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige {

/// The skin that one joint moves: the triangles in which the joint has the largest sum of weights.
struct JointSkin {
  std::size_t palette = 0;  ///< entry of `Avatar::palette`
  /// In the joint's bind space, as the skin lies in the rest pose: the joint's skinning matrix of the rest pose moves
  /// the corners to the skin at rest.
  RestPatch patch;
};

/// Returns the skin of every joint that moves any, by ascending palette entry. Each triangle belongs to one joint. A
/// joint that is scaled to nothing at rest has no skin.
std::vector<JointSkin> skin_by_joint(const Avatar& avatar);

}  // namespace vestige
