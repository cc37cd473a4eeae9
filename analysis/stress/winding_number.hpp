#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <span>

namespace vestige {

/// How often a closed surface winds around a point, exactly: positive where its front faces outwards. Empty where the
/// point may lie on the surface: it is in the plane of a triangle that its half-line along +x passes.
///
/// Triangles that the half-line crosses count by the sign of their volume with the point, the half-line being moved
/// aside by an infinitesimal amount, the same for all: a triangle's projection along x contains it by the half-open
/// crossing rule (Hormann, Agathos 2001, "The point in polygon problem for arbitrary polygons"). Signs are exact, so
/// that edges count for one of their two triangles. `triangles` index `vertices`; every edge must be there in both
/// directions, by its places.
std::optional<int> winding_number(std::span<const glm::vec3> vertices, std::span<const glm::uvec3> triangles,
                                  const glm::vec3& point);

}  // namespace vestige
