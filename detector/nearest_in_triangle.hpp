#pragma once

#include <glm/vec3.hpp>

#include "detector/decision.hpp"

namespace vestige {

/// Returns the weights of the corners for the point of a triangle nearest to `p` (Ericson 2005, Real-Time Collision
/// Detection, 5.1.5).
glm::dvec3 nearest_in_triangle(const glm::dvec3& p, const Corners& triangle);

}  // namespace vestige
