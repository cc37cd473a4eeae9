#pragma once

#include <glm/vec3.hpp>

#include "detector/decision.hpp"

namespace vestige {

/// Returns the weights of the corners for the point of a triangle nearest to `p` (Ericson 2005, Real-Time Collision
/// Detection, 5.1.5).
glm::dvec3 nearest_in_triangle(const glm::dvec3& p, const Corners& triangle);

/// Does the same for the triangle's edges alone, whatever their lengths.
glm::dvec3 nearest_on_edges(const glm::dvec3& p, const Corners& triangle);

/// Returns whether each weight is from 0 to 1. Those of `nearest_in_triangle` may not be if a triangle has no area.
bool are_shares(const glm::dvec3& weights);

/// Returns the squared distance from a point to a box with these corners; 0 inside.
double squared_distance_to_box(const glm::dvec3& point, const glm::dvec3& low, const glm::dvec3& high);

/// Returns the point of a triangle with these weights.
glm::dvec3 weighed(const glm::dvec3& weights, const Corners& triangle);

}  // namespace vestige
