#pragma once

#include <compare>
#include <optional>
#include <vector>

#include "detector/decide/triangle_distance.hpp"
#include "detector/decision.hpp"

namespace vestige {

/// The distance between a sphere's centre and a triangle at the start of a frame, for the choice of the winner among
/// triangles that the sphere touches there (detector/CONTRACT.md, Spheres). Comparisons are exact.
class StartDistance {
 public:
  StartDistance(const glm::dvec3& centre, const Corners& triangle);

  const DistanceRange& range() const { return range_; }

  /// Compares two distances. Sets `exact_arithmetic` if neither their ranges nor a shared nearest part decide.
  static std::strong_ordering compare(const StartDistance& a, const StartDistance& b, bool& exact_arithmetic);
  /// Compares with a radius.
  static std::strong_ordering compare(const StartDistance& a, double radius, bool& exact_arithmetic);

 private:
  /// Returns the corners whose hull is the nearest part of the triangle, sorted, if double precision proves which part
  /// that is. Triangles that share an edge or a corner share it, too, so their distances are equal.
  std::optional<std::vector<glm::dvec3>> nearest_part() const;

  glm::dvec3 centre_;
  Corners triangle_;
  DistanceRange range_;
};

}  // namespace vestige
