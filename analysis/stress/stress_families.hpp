#pragma once

#include <span>
#include <string_view>

#include "analysis/stress/stress_scene.hpp"

namespace vestige {

/// A family of hostile cases.
struct StressFamily {
  std::string_view name;
  std::string_view variant;    ///< distinguishes families of one name; mostly empty
  std::string_view meaning;    ///< one sentence
  std::string_view magnitude;  ///< what the magnitudes are, and their unit
  std::span<const double> magnitudes;
  StressBody body;
  StressScene (*make)(StressOrder order);
  bool has_spheres = false;  ///< detectors that test only the centres of spheres are left out
};

/// All families, in the order in which they run: loose triangles (stress_triangles.cpp), a posed avatar
/// (stress_poses.cpp), the ladder (watertight.cpp), and loose triangles with spheres (stress_spheres.cpp).
std::span<const StressFamily> triangle_families();
std::span<const StressFamily> pose_families();
std::span<const StressFamily> watertight_families();
std::span<const StressFamily> sphere_families();

}  // namespace vestige
