#pragma once

#include <cstdint>
#include <string>

#include "detector/contact.hpp"

namespace vestige {

/// How the contacts of one run differ from the contacts of another, counted row by row.
struct Comparison {
  std::uint64_t expected = 0;        ///< contacts of the other run
  std::uint64_t missing = 0;         ///< the other run has a contact, this run does not
  std::uint64_t extra = 0;           ///< this run has a contact, the other run does not
  std::uint64_t other_triangle = 0;  ///< both runs have a contact, on different triangles
  std::uint64_t other_actuator = 0;  ///< on the same triangle, with different actuators
  std::uint64_t other_t = 0;         ///< on the same triangle, with different bits of t
  double largest_t_difference = 0;   ///< among contacts on the same triangle

  void add(const ContactRow& row, const ContactRow& expected_row);

  /// Returns the contacts that a user would feel or map differently. A difference in the bits of t alone does not
  /// count.
  std::uint64_t differing() const { return missing + extra + other_triangle + other_actuator; }
};

/// "3 contacts differ from the 812 expected (…)".
std::string describe(const Comparison& comparison);

}  // namespace vestige
