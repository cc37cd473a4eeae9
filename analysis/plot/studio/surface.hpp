#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "traces/scene/avatar.hpp"

namespace vestige::plot {

/// An avatar in one pose, as it is drawn.
struct Surface {
  std::vector<glm::vec3> position;                       ///< of every vertex, metres from the origin of the pose
  std::vector<glm::uvec3> triangles;                     ///< the avatar's triangles in the avatar's order
  std::vector<std::array<glm::vec3, 3>> corner_normals;  ///< of every triangle: unit length, smooth across soft edges
  Facing facing = Facing::kPlusZ;                        ///< of the avatar at rest
  glm::dvec3 low = glm::dvec3(0);                        ///< lower corner of the triangles' bounding box
  glm::dvec3 high = glm::dvec3(0);

  double height() const { return high.y - low.y; }
  /// Returns the point of `triangle` at which its second and third vertex weigh `u` and `v`.
  glm::dvec3 point(std::uint32_t triangle, double u, double v) const;
  glm::dvec3 normal(std::uint32_t triangle, double u, double v) const;

  /// Adds another surface, posed about the same origin, behind the triangles of this one. The facing stays.
  void append(const Surface& other);
};

/// Poses an avatar. Edges sharper than 50 degrees stay sharp. Texture seams are not visible.
class SurfacePoser {
 public:
  /// `avatar` must outlive this object.
  explicit SurfacePoser(const Avatar& avatar);
  Surface pose(const Pose& pose, const glm::dvec3& origin_m) const;

 private:
  const Avatar& avatar_;
  /// The place of every vertex. Vertices at one position that move as one share a place.
  std::vector<std::uint32_t> place_;
  std::size_t place_count_ = 0;
};

}  // namespace vestige::plot
