#pragma once

#include <cstdint>
#include <string>

#include "detector/contact.hpp"

namespace vestige {

/// How the contacts of one run differ from those of another, counted row by row.
struct Comparison {
  std::uint64_t expected = 0;        ///< contacts of the other run
  std::uint64_t missing = 0;         ///< it has one, this run has none
  std::uint64_t extra = 0;           ///< the other way round
  std::uint64_t other_triangle = 0;  ///< both have one, on different triangles
  std::uint64_t other_actuator = 0;  ///< on the same triangle, with different actuators
  std::uint64_t other_t = 0;         ///< on the same triangle, with t of other bits
  double largest_t_difference = 0;   ///< among contacts on the same triangle

  void add(const ContactRow& row, const ContactRow& expected_row);

  /// Contacts that a user would feel or map differently. A t of other bits alone is none.
  std::uint64_t differing() const { return missing + extra + other_triangle + other_actuator; }
};

/// "3 contacts differ from the 812 expected (…)".
std::string describe(const Comparison& comparison);

}  // namespace vestige
