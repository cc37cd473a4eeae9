#pragma once

#include <array>
#include <glm/vec3.hpp>

#include "detector/broad/meshlet_skin.hpp"
#include "detector/broad/meshlets.hpp"

namespace vestige {

/// Bounds of the squared distances from a point to the triangles of a meshlet, in square metres. They hold exactly:
/// rounding only widens them.
struct StartBounds {
  alignas(64) std::array<float, kMeshletTriangles> at_least;  ///< to the box around the triangle; may be infinite
  std::array<float, kMeshletTriangles> to_a_corner_at_most;   ///< to the nearest corner; may be infinite
};

/// Computes them for all triangles at once. Entries after the meshlet's last triangle have no meaning.
void find_start_bounds(const MeshletCorners& corners, const glm::vec3& point, StartBounds& out);

}  // namespace vestige
