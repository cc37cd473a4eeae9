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
  std::vector<glm::vec3> position;                       ///< of every vertex, in metres from the origin it was posed at
  std::vector<glm::uvec3> triangles;                     ///< the avatar's, in its order
  std::vector<std::array<glm::vec3, 3>> corner_normals;  ///< of every triangle: unit length, smooth across soft edges
  glm::dvec3 low = glm::dvec3(0);                        ///< what the triangles lie between
  glm::dvec3 high = glm::dvec3(0);

  double height() const { return high.y - low.y; }
  /// The point of `triangle` where its second and third vertex weigh `u` and `v`.
  glm::dvec3 point(std::uint32_t triangle, double u, double v) const;
  glm::dvec3 normal(std::uint32_t triangle, double u, double v) const;
};

/// Poses an avatar. Edges sharper than 50 degrees stay sharp; seams of the texture do not show.
class SurfacePoser {
 public:
  /// `avatar` must stay.
  explicit SurfacePoser(const Avatar& avatar);
  Surface pose(const Pose& pose, const glm::dvec3& origin_m) const;

 private:
  const Avatar& avatar_;
  std::vector<std::uint32_t> place_;  ///< of every vertex: the same for vertices at one place that move as one
  std::size_t place_count_ = 0;
};

}  // namespace vestige::plot
