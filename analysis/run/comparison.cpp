#include "analysis/run/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace vestige {

namespace {
const Contact kNone;
}

void Comparison::add(const ContactRow& row, const ContactRow& expected_row) {
  const std::size_t columns = std::max(row.size(), expected_row.size());
  for (std::size_t column = 0; column < columns; ++column) {
    const Contact& mine = column < row.size() ? row[column] : kNone;
    const Contact& theirs = column < expected_row.size() ? expected_row[column] : kNone;
    if (theirs.hit()) ++expected;
    if (!mine.hit() && !theirs.hit()) continue;
    if (!mine.hit()) {
      ++missing;
    } else if (!theirs.hit()) {
      ++extra;
    } else if (mine.triangle != theirs.triangle) {
      ++other_triangle;
    } else {
      if (mine.actuator != theirs.actuator) ++other_actuator;
      if (std::bit_cast<std::uint32_t>(mine.t) != std::bit_cast<std::uint32_t>(theirs.t)) ++other_t;
      largest_t_difference =
          std::max(largest_t_difference, std::abs(static_cast<double>(mine.t) - static_cast<double>(theirs.t)));
    }
  }
}

std::string describe(const Comparison& comparison) {
  return fmt::format(
      "{} contacts differ from the {} expected ({} missing, {} extra, {} on another triangle, {} with another "
      "actuator); t differs in its bits in {}, by {:.3g} at most",
      comparison.differing(), comparison.expected, comparison.missing, comparison.extra, comparison.other_triangle,
      comparison.other_actuator, comparison.other_t, comparison.largest_t_difference);
}

}  // namespace vestige
