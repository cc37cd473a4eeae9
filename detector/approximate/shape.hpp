#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <span>

#include "detector/decision.hpp"

namespace vestige {

/// The times at which a way, continued beyond both ends, enters and leaves a convex shape. It misses if enter > leave.
/// A way without length that stays inside enters at -inf and leaves at +inf.
struct Chord {
  double enter = -std::numeric_limits<double>::infinity();
  double leave = std::numeric_limits<double>::infinity();

  bool misses() const { return enter > leave; }
  static Chord none() { return {1, 0}; }
};

/// Returns a chord limited to the times at which `position + t speed` lies within [-half, half]. None if `half` is
/// negative.
Chord within_slab(Chord chord, double position, double speed, double half);

/// The middle of a surface, and its three main directions.
struct MainAxes {
  glm::dvec3 middle;
  glm::dmat3 axes;  ///< columns of length 1, right-handed, by falling extent
};

/// Returns the main axes of the area of triangles, by the moments of the area itself: how finely it is cut into
/// triangles does not matter. For triangles without area, those of their corners. Precondition: there is a triangle.
MainAxes main_axes(std::span<const Corners> triangles);

}  // namespace vestige
