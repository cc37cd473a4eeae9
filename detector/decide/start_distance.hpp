#pragma once

#include <array>
#include <optional>

#include "detector/decide/triangle_distance.hpp"
#include "detector/decision.hpp"

namespace vestige {

/// The distance between a sphere's centre and a triangle at the start of a frame, for the choice of the winner among
/// triangles that the sphere touches there (detector/CONTRACT.md, Spheres). Comparisons are exact.
class StartDistance {
 public:
  StartDistance(const glm::dvec3& centre, const Corners& triangle);

  const DistanceRange& range() const { return range_; }

  /// Returns -1, 0 or 1 if `a` is less than, equal to or greater than `b`. Sets `exact_arithmetic` if neither their
  /// ranges nor a shared nearest part decide.
  static int compare(const StartDistance& a, const StartDistance& b, bool& exact_arithmetic);
  /// The same for a distance and a radius.
  static int compare(const StartDistance& a, double radius, bool& exact_arithmetic);

 private:
  /// Returns the ends of the edge that is the nearest part of the triangle, sorted, if double precision proves that it
  /// is; a corner is an edge with two equal ends. Triangles that share it have equal distances.
  std::optional<std::array<glm::dvec3, 2>> nearest_edge() const;

  glm::dvec3 centre_;
  Corners triangle_;
  DistanceRange range_;
};

}  // namespace vestige
