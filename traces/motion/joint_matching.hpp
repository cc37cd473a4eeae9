#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "traces/motion/skeleton.hpp"

namespace vestige {

/// Returns the joint of the motion that each joint of the avatar follows. Joints are matched by their role in a body,
/// spines from both ends, then those without a role by equal names. Joints that are not usable follow nothing.
std::vector<std::optional<std::size_t>> match_joints(const Skeleton& motion, const Skeleton& avatar);

}  // namespace vestige
