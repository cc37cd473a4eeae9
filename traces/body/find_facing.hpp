#pragma once

#include "traces/scene/avatar.hpp"
#include "traces/scene/facing.hpp"
#include "traces/scene/humanoid.hpp"

namespace vestige {

/// Finds which way an avatar looks in its rest pose. In this order of trust: hips, shoulders, arms and hands named left
/// and right; the way from feet to toes; the version of VRM (0.x looks along -z, 1.0 along +z); otherwise +z. The axis
/// nearest to what is found counts. What contradicts it becomes `AvatarFacing::doubt`.
AvatarFacing find_facing(const Avatar& avatar, const Humanoid& humanoid);

}  // namespace vestige
