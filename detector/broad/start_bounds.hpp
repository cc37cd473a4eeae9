#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>

#include "detector/broad/meshlet_skin.hpp"
#include "detector/broad/meshlets.hpp"

namespace vestige {

/// Triangles of a meshlet, a bit for each. Bits after the last triangle have no meaning.
struct StartMasks {
  std::uint32_t farther = 0;        ///< surely farther than a limit
  std::uint32_t apart = 0;          ///< surely farther than a radius
  std::uint32_t corner_within = 0;  ///< a corner is surely within the radius
};

/// Bounds of the squared distances from a point to the triangles of a meshlet, in square metres. Rounding only widens
/// them.
class StartBounds {
 public:
  /// Computes the bounds for all triangles at once.
  void find(const MeshletCorners& corners, const glm::vec3& point);

  /// Compares them with two lengths, in metres. `limit` may be infinite.
  StartMasks compare(double limit, double radius) const;

  /// Returns the triangle whose box is nearest, of those whose bits are set. Precondition: a bit is set.
  std::size_t nearest(std::uint32_t bits) const;

  struct Numbers {
    alignas(64) std::array<float, kMeshletTriangles> at_least;  ///< to the box around the triangle; may be infinite
    std::array<float, kMeshletTriangles> to_a_corner_at_most;   ///< to the nearest corner; may be infinite
  };

 private:
  Numbers squared_m2_ = {};
};

}  // namespace vestige
