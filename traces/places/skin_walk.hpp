#pragma once

#include <cstdint>
#include <vector>

#include "traces/places/skin.hpp"

namespace vestige {

/// A straight step within one triangle, at constant speed.
struct SkinStep {
  double start_s = 0;
  double end_s = 0;
  SkinPoint from;
  glm::dvec3 to_weight;           ///< its end in the same triangle
  glm::dvec3 heading;             ///< along the skin at rest, length 1
  std::uint32_t exit_corner = 3;  ///< the step ends on the edge opposite to this corner; 3: within the triangle

  SkinPoint at(double time_s) const;
};

/// Paths along the skin. They run straight across the edges between triangles, with small turns now and then, and turn
/// back at edges without another side. Lengths are those of the rest pose. Keeps a reference to the skin.
class SkinWalk {
 public:
  /// Precondition: `speed_m_per_s` and `straight_m` (the longest path without a turn) are above 0.
  SkinWalk(const Skin& skin, double speed_m_per_s, double straight_m);

  SkinStep begin(double time_s, Random& random) const;
  SkinStep next(const SkinStep& step, Random& random) const;

 private:
  struct Crossing {
    SkinPoint point;
    glm::dvec3 heading;
    glm::dvec3 inwards;  ///< away from the edge, length 1
  };
  Crossing cross(const SkinStep& step) const;
  SkinStep step_from(double start_s, const SkinPoint& from, const glm::dvec3& heading) const;
  glm::dvec3 normal_of(std::uint32_t triangle) const;  // not of length 1
  const glm::dvec3& corner_m(std::uint32_t triangle, std::uint32_t corner) const;

  const Skin& skin_;
  double speed_m_per_s_;
  double straight_m_;
  std::vector<std::uint32_t> neighbours_;  // three for each triangle: the one across the edge opposite to each corner
};

}  // namespace vestige
