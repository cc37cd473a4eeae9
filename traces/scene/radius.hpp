#pragma once

#include <cmath>
#include <string_view>

namespace vestige {

inline constexpr float kLargestRadius_m = 10;  ///< of a collider; a larger one counts as a mistake
/// About a nanometre. A collider with a smaller radius is a point.
inline constexpr float kSmallestRadius_m = 0x1p-30F;

/// Whether a collider with this radius is a sphere.
inline bool is_sphere_radius(float radius_m) {
  return radius_m >= kSmallestRadius_m;
}

/// Returns why a collider cannot have this radius, to follow "the radius": "is negative". Empty if it can.
inline std::string_view radius_fault(double radius_m) {
  if (!std::isfinite(radius_m)) return "is not finite";
  if (radius_m < 0) return "is negative";
  if (radius_m > double{kLargestRadius_m}) return "is larger than 10 m";
  return {};
}

}  // namespace vestige
