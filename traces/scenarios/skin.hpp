#pragma once

#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "traces/scenarios/random.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige {

/// A point of the skin that goes with it: a triangle, and the weights of its corners (sum 1).
struct SkinPoint {
  std::uint32_t triangle = 0;
  glm::dvec3 weight = glm::dvec3(1, 0, 0);
};

/// Where a point of the skin is, in metres, and which way the skin faces there (length 1).
struct SkinPlace {
  glm::dvec3 position_m;
  glm::dvec3 normal;
};

/// Points on an avatar's skin. Only the corners of the triangles that are asked for are skinned. Holds a reference to
/// the avatar.
class Skin {
 public:
  explicit Skin(const Avatar& avatar);

  const Avatar& avatar() const { return avatar_; }
  /// Every vertex in the rest pose, metres.
  const std::vector<glm::dvec3>& rest_m() const { return rest_m_; }

  /// For every vertex a number that it shares with those that are always in the same place, such as its likes across a
  /// texture's seam: that of one of them.
  const std::vector<std::uint32_t>& weld() const { return weld_; }

  /// Every bit of skin alike, by its area at rest. Without any area, a corner of any triangle.
  SkinPoint random_point(Random& random) const;

  /// Under the palette of a pose. The normal blends those of the corners, so it turns without jumps along the skin.
  SkinPlace place(const SkinPoint& point, const std::vector<glm::dmat4>& palette) const;

  /// The normal of a posed triangle itself; 0 where it has no area.
  glm::dvec3 face_normal(std::uint32_t triangle, const std::vector<glm::dmat4>& palette) const;

 private:
  const Avatar& avatar_;
  std::vector<glm::dvec3> rest_m_;
  std::vector<std::uint32_t> weld_;
  std::vector<glm::dvec3> normal_bind_;  // by the weld's numbers; length 1, or 0 where there is no area
  std::vector<double> area_up_to_;       // that of the triangles so far, square metres
};

}  // namespace vestige
