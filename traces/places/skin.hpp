#pragma once

#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "traces/places/random.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige {

/// A point that moves with the skin: a triangle, and the weights of its corners (sum 1).
struct SkinPoint {
  std::uint32_t triangle = 0;
  glm::dvec3 weight = glm::dvec3(1, 0, 0);
};

/// Position of a point of the skin, in metres, and the skin's normal there (length 1).
struct SkinPlace {
  glm::dvec3 position_m;
  glm::dvec3 normal;
};

/// Points on an avatar's skin. Skins only the corners of requested triangles. Keeps a reference to the avatar.
class Skin {
 public:
  explicit Skin(const Avatar& avatar);

  const Avatar& avatar() const { return avatar_; }
  /// All vertices in the rest pose, in metres.
  const std::vector<glm::dvec3>& rest_m() const { return rest_m_; }

  /// For every vertex, the index of a vertex that represents all vertices that are always at the same place, such as
  /// its copies across a texture seam.
  const std::vector<std::uint32_t>& weld() const { return weld_; }

  /// Returns a random point, uniformly distributed by the skin's area at rest. Without any area, returns a corner of
  /// any triangle.
  SkinPoint random_point(Random& random) const;

  /// Returns the place of a point under the palette of a pose. The normal blends the normals of the corners, so it
  /// turns without jumps along the skin.
  SkinPlace place(const SkinPoint& point, const std::vector<glm::dmat4>& palette) const;

  /// Returns the normal of a posed triangle itself, or 0 if the triangle has no area.
  glm::dvec3 face_normal(std::uint32_t triangle, const std::vector<glm::dmat4>& palette) const;

 private:
  const Avatar& avatar_;
  std::vector<glm::dvec3> rest_m_;
  std::vector<std::uint32_t> weld_;
  std::vector<glm::dvec3> normal_bind_;  // by `weld_` index; length 1, or 0 if there is no area
  std::vector<double> area_up_to_;       // cumulative area of the triangles, in square metres
};

}  // namespace vestige
