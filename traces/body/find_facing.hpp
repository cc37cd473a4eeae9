#pragma once

#include "traces/scene/avatar.hpp"
#include "traces/scene/facing.hpp"
#include "traces/scene/humanoid.hpp"

namespace vestige {

/// Finds which way an avatar looks in its rest pose. In this order of trust: hips, shoulders, arms and hands named left
/// and right; the way from feet to toes; the version of VRM (0.x looks along -z, 1.0 along +z); otherwise +z. The axis
/// nearest to what is found counts. What contradicts it becomes `AvatarFacing::doubt`.
///
/// A body does not stand if the direction from hips to head is more than 45 degrees away from +Y, unless its thighs
/// (or shins, if these are not known) point down within 45 degrees. So does an animal, or a person on all fours, whose
/// left and front are what they seem. For a body that does not stand, +z is assumed, without a doubt, and
/// `AvatarFacing::lies_deg` is its angle.
AvatarFacing find_facing(const Avatar& avatar, const Humanoid& humanoid);

}  // namespace vestige
