#pragma once

#include "detector/decision.hpp"

namespace vestige {

/// A proven range of the distance from a point to a closed triangle.
struct DistanceRange {
  double low = 0;
  double high = 0;
};

/// A proven range of a distance, and the unit vector, up to rounding, along which the triangle is that far away. The
/// vector is zero if the point is on the triangle, or nearly so.
struct Separation {
  DistanceRange range;
  glm::dvec3 direction;
};

/// Returns how far corners are from the origin at most, in the sum of their coordinates' sizes, rounded up. Holds for
/// corners that `corners` approximates by 2 kUnit in each coordinate, too.
double reach_of(const Corners& corners);

/// Whether `distance_to` can take this reach, which is neither zero, nor denormal, nor huge.
bool is_in_range(double reach);

/// Returns a range that contains the distance from the origin to the triangle whose corners are exactly those that
/// `corners` approximates: each computed coordinate errs by at most 4 kUnit * `reach`. No corner, exact or computed, is
/// farther from the origin than `reach`, in the sum of its coordinates' sizes. The range is about 1e-14 * `reach` wide,
/// however degenerate the triangle is. Requires is_in_range(reach).
Separation separation_from(const Corners& corners, double reach);

}  // namespace vestige
