#pragma once

#include <string>
#include <vector>

#include "traces/exchange/convention.hpp"

namespace vestige {

/// A way to understand the positions in a file.
struct Reading {
  Convention convention;
  std::string words;        ///< "in centimetres and with the axes of unity"; empty for the file as it was read
  std::string flags;        ///< what asks for it: "--collider-unit cm"
  std::size_t changes = 0;  ///< how many flags; an order of columns counts as two
  bool has_other_unit = false;
  bool has_other_columns = false;

  bool is_mirrored_from(const Convention& other) const;
};

/// Returns every unit with every program's axes, and every order of columns: all but `convention` itself. The simplest
/// come first, and before others those that mirror nothing: a body is about its own mirror image, so that only
/// simplicity tells which of the two is meant.
std::vector<Reading> other_readings(const Convention& convention);

}  // namespace vestige
