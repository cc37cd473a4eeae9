#pragma once

#include <array>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "traces/scene/avatar.hpp"

namespace vestige {

/// Bounds how far apart two poses put an avatar's skin. A skinned vertex is a weighted mean of where its joints put it.
/// So it moves by at most what the most moved of its joints moves the box around all vertices of that joint, which a
/// corner of the box shows.
class SkinDifference {
 public:
  /// Keeps a reference to the avatar.
  explicit SkinDifference(const Avatar& avatar);

  struct Bound {
    double most_m = 0;     ///< no vertex of the skin differs by more
    std::size_t node = 0;  ///< the joint of this corner
  };
  /// Precondition: both poses are finite.
  Bound between(const Pose& a, const Pose& b);

 private:
  struct Part {
    std::size_t node = 0;
    std::array<glm::dvec3, 8> corners = {};  ///< of the box, in the node's frame
  };

  const Avatar& avatar_;
  std::vector<Part> parts_;
  std::vector<glm::dmat4> world_a_;
  std::vector<glm::dmat4> world_b_;
};

}  // namespace vestige
