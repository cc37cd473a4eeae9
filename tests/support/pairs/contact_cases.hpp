#pragma once

#include <cstdint>
#include <random>
#include <span>
#include <string_view>

#include "detector/decision.hpp"

namespace vestige::test {

/// A point's way and a triangle that moves, to be asked about with `ccd`; with `static` the triangle is `after`.
struct ContactCase {
  Way way;
  Corners before;
  Corners after;
};

/// What is hard about a case. Some families change cases of the others: ulp, scale, offset.
std::span<const std::string_view> case_families();

/// Seeded cases of one family: the same seed gives the same cases, on every machine. Half of them hold fp32 numbers
/// only. All numbers are finite, but not all their differences are: `extreme` has exponents of every size.
class CaseGenerator {
 public:
  /// Throws `std::invalid_argument` where no family has this name.
  CaseGenerator(std::string_view family, std::uint64_t seed);

  ContactCase next();

 private:
  std::size_t family_;
  std::mt19937_64 random_;
};

}  // namespace vestige::test
