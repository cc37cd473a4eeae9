#pragma once

#include <string>
#include <vector>

#include "traces/exchange/convention.hpp"

namespace vestige {

/// A way to understand the positions in a file.
struct Reading {
  Convention convention;
  std::string words;   ///< "in centimetres and with the axes of unity"; empty for the file as it was read
  std::string flags;   ///< what asks for it: "--collider-unit cm"
  double changes = 0;  ///< how far it is from the file as it was read: 1 for one flag, less for each further one
  bool has_other_unit = false;
  bool has_other_columns = false;
};

/// Returns every unit with every program's axes, and every order of columns: all but `convention` itself. The simplest
/// come first, and before others right-handed axes and orders that mirror nothing: a body is about its own mirror
/// image, so that only simplicity tells which of the two is meant.
std::vector<Reading> other_readings(const Convention& convention);

}  // namespace vestige
