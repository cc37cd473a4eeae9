#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <span>

namespace vestige {

/// Returns the exact winding number of a closed surface around a point. It is positive if the surface's front faces
/// outwards. Returns nothing if the point may lie on the surface: the point is in the plane of a triangle that the
/// point's half-line along +x may cross.
///
/// Each triangle that the half-line crosses counts by the sign of its volume with the point. The half-line is moved
/// aside by an infinitesimal amount, the same for all triangles: whether a triangle's projection along x contains it
/// follows the half-open crossing rule (Hormann, Agathos 2001, "The point in polygon problem for arbitrary polygons").
/// Signs are exact, so that an edge counts for exactly one of its two triangles. `triangles` index `vertices`. Every
/// edge must occur in both directions, compared by position.
std::optional<int> winding_number(std::span<const glm::vec3> vertices, std::span<const glm::uvec3> triangles,
                                  const glm::vec3& point);

}  // namespace vestige
