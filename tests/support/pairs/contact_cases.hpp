#pragma once

#include <cstdint>
#include <random>
#include <span>
#include <string_view>

#include "detector/decision.hpp"

namespace vestige::test {

/// A point's way and a moving triangle, for `ccd`. For `static`, the triangle is `after`.
struct ContactCase {
  Way way;
  Corners before;
  Corners after;
};

/// The same for a sphere.
struct SphereCase {
  MovingSphere sphere;
  Corners before;
  Corners after;
};

/// Returns the names of the case families. A family says what makes its cases hard. The families ulp, scale and offset
/// change cases of other families.
std::span<const std::string_view> case_families();

/// Generates seeded cases of one family. The same seed gives the same cases on every machine. Half of the cases hold
/// fp32 numbers only. All numbers are finite, but their differences may not be: `extreme` has exponents of every size.
class CaseGenerator {
 public:
  /// Throws `std::invalid_argument` if no family has this name.
  CaseGenerator(std::string_view family, std::uint64_t seed);

  ContactCase next();

  /// Returns a case of the family with a radius: any, the distance at the start or at the end, or within an ulp of it,
  /// far too small, or larger than everything. Often the way is shifted by the radius, so that the sphere's surface
  /// passes where the point would.
  SphereCase next_sphere();

 private:
  std::size_t family_;
  std::mt19937_64 random_;
};

}  // namespace vestige::test
