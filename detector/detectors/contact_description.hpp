#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "detector/actuator_map.hpp"
#include "detector/broad/skin_motion.hpp"
#include "detector/contact.hpp"
#include "detector/decision.hpp"
#include "detector/frame.hpp"
#include "detector/method.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige {

/// Returns u, v: the weights of b and c for the point of triangle a b c nearest to `x` in the triangle's plane, clamped
/// to the triangle. For a triangle without area, the point is the nearest point of the longest edge.
glm::dvec2 barycentric_of(const glm::dvec3& x, const Corners& triangle);

/// A way and a triangle that meet at time t.
struct Meeting {
  std::uint32_t triangle;
  Way way;
  Corners at_contact;  ///< the triangle at time t
  FirstContact first;
};

/// Returns everything about a contact that follows from the pair and t. All detectors use this one fp64 function
/// (detector/CONTRACT.md, 7 and 8). `duration_s` is the duration of the frame.
Contact describe_contact(const Avatar& avatar, const ActuatorMap& map, const Meeting& meeting, double duration_s);

/// A sphere and a triangle, moving as the method takes them: for `static` and `carried`, the triangle rests, and for
/// `carried` the centre's start is moved with the skin.
struct SpherePair {
  std::uint32_t triangle;
  MovingSphere sphere;
  Corners before;
  Corners now;
};

SpherePair sphere_pair(const Segment& segment, const MovingCorners& corners, std::uint32_t triangle, Method method);

/// Does the same as `describe_contact` for a sphere: u, v and position are those of the skin's point nearest to the
/// centre at time t, and the speed is along the line between the two (detector/CONTRACT.md, Spheres).
Contact describe_touch(const Avatar& avatar, const ActuatorMap& map, const SpherePair& pair, const FirstTouch& touch,
                       double duration_s);

}  // namespace vestige
