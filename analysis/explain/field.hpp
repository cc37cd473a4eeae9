#pragma once

#include <span>
#include <string_view>
#include <vector>

namespace vestige {

/// What a name of a file means.
struct Field {
  std::string_view name;     ///< a column, channel, table or path of JSON ("machine/cores"); "*" stands for any text
  std::string_view unit;     ///< empty: none
  std::string_view meaning;  ///< with range, frame, and what null, 0 or inf says
};

/// Fields with a path in front of their names.
struct FieldGroup {
  std::string_view below;  ///< "gl": the names are gl/renderer and so on; empty: the names stand at the top
  std::span<const Field> fields;
};

using FieldGroups = std::vector<FieldGroup>;

}  // namespace vestige
