#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "detector/method.hpp"

namespace vestige::test {

/// How the deciding code and the slow truth compare.
struct Agreement {
  std::uint64_t pairs = 0;
  std::uint64_t contacts = 0;
  std::uint64_t exact_arithmetic = 0;  ///< pairs for which the deciding code needed it
  std::uint64_t differences = 0;       ///< in whether, in any bit of t, or in the side
  std::vector<std::string> examples;   ///< the first differences, in hexadecimal numbers

  void add(const Agreement& other);
};

/// Asks `decide_static` or `decide_ccd`, and `exact::`, about `pairs` cases of a family (contact_cases.hpp).
Agreement compare_with_truth(Method method, std::string_view family, std::uint64_t seed, std::uint64_t pairs);

}  // namespace vestige::test
