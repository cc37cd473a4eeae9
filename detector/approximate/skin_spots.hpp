#pragma once

#include <glm/vec3.hpp>

#include "detector/actuator_map.hpp"
#include "detector/approximate/joint_skin.hpp"
#include "detector/contact.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige {

/// A place of the skin, as a contact tells it: its triangle, barycentric, texture coordinate and actuator. The other
/// members are at their defaults.
using SkinSpot = Contact;

/// Returns the place of `skin` nearest to a point of the joint's bind space.
SkinSpot nearest_spot(const Avatar& avatar, const ActuatorMap& map, const JointSkin& skin, const glm::dvec3& point);

}  // namespace vestige
