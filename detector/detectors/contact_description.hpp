#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "detector/actuator_map.hpp"
#include "detector/contact.hpp"
#include "detector/decision.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige {

/// u, v: the weights of b and c in the point of triangle a b c nearest to `x` in its plane, clamped to the triangle. A
/// triangle without area gives the nearest point of its longest edge.
glm::dvec2 barycentric_of(const glm::dvec3& x, const Corners& triangle);

/// A pair that meets.
struct Meeting {
  std::uint32_t triangle;
  Way way;
  Corners at_contact;  ///< the triangle as it is at time t
  FirstContact first;
};

/// Everything about a contact that follows from the pair and t, in one fp64 function for every detector
/// (detector/CONTRACT.md, 7 and 8). `duration_s`: of the frame.
Contact describe_contact(const Avatar& avatar, const ActuatorMap& map, const Meeting& meeting, double duration_s);

}  // namespace vestige
