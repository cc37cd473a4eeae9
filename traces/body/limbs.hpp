#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "traces/scene/avatar.hpp"

namespace vestige {

/// A sphere that stands for a piece of a limb. It moves with a node of the avatar.
struct LimbSphere {
  std::size_t node = 0;
  glm::dvec3 centre = glm::dvec3(0);  ///< in the node's frame
  float radius_m = 0;
};

/// The names of limbs: "hand_left", "forearm_right", …, "head", "neck", "torso".
const std::vector<std::string>& limb_names();

/// Returns spheres along a limb of the avatar, from one end of its skin to the other; a limb that is twice as long as
/// thick gets two. Each is as large as its piece of the skin is thick at rest, and moves with the node that carries
/// most of it. `limb` is one of `limb_names`. Empty if the names of the avatar's joints do not tell the limb.
std::vector<LimbSphere> fit_limb(const Avatar& avatar, std::string_view limb);

}  // namespace vestige
