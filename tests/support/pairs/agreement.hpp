#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "detector/method.hpp"

namespace vestige::test {

/// How the deciding code agrees with the slow exact check.
struct Agreement {
  std::uint64_t pairs = 0;
  std::uint64_t contacts = 0;
  std::uint64_t exact_arithmetic = 0;  ///< pairs for which the deciding code needed exact arithmetic
  std::uint64_t differences = 0;       ///< differences in contact or miss, in any bit of t, or in the side
  double slowest_s = 0;  ///< thread time of the slowest decision that a trace can bring, the least of three
  std::vector<std::string> examples;  ///< the first differences, with hexadecimal numbers

  void add(const Agreement& other);
};

/// Compares `decide_static` or `decide_ccd` with `exact::` on `pairs` cases of a family (contact_cases.hpp).
Agreement compare_with_truth(Method method, std::string_view family, std::uint64_t seed, std::uint64_t pairs);

/// The same for `decide_sphere`, and for the comparison of two distances at the start.
Agreement compare_spheres_with_truth(Method method, std::string_view family, std::uint64_t seed, std::uint64_t pairs);

}  // namespace vestige::test
