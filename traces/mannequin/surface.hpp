#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <vector>

namespace vestige::mannequin {

/// A closed triangle mesh, symmetric about x = 0: vertex i's mirror image is `mirror[i]` (i itself on the plane).
struct Surface {
  std::vector<glm::dvec3> positions_m;
  std::vector<glm::uvec3> triangles;  ///< counter-clockwise from outside
  std::vector<std::uint32_t> mirror;
};

/// Returns the body's surface. The left half is contoured (flying edges) on a grid of `spacing_m`, simplified (edge
/// collapse after Lindstrom and Turk 1998) to half of `triangle_count`, and mirrored.
Surface make_surface(double spacing_m, std::size_t triangle_count);

}  // namespace vestige::mannequin
