#include "traces/questions/readings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <glm/matrix.hpp>

namespace vestige {

namespace {

constexpr double kFurtherFlag = 0.3;
/// Columns are put into a wrong order less often than axes are those of another program.
constexpr double kOrderOfColumns = 2.5;

std::string_view unit_word(std::string_view unit) {
  if (unit == "cm") return "centimetres";
  if (unit == "mm") return "millimetres";
  return unit == "in" ? "inches" : "metres";
}

Reading with(const Convention& convention, const AxisPreset& preset, const Unit& unit) {
  Reading found = {convention, "", ""};
  found.convention.metres_per_unit = unit.size;
  found.convention.axes = axes_named(preset.name);
  const bool has_other_axes = found.convention.axes != convention.axes;
  found.has_other_unit = unit.size != convention.metres_per_unit;
  std::vector<std::string> words;
  if (found.has_other_unit) words.push_back(fmt::format("in {}", unit_word(unit.name)));
  if (has_other_axes) words.push_back(fmt::format("with the axes of {}", preset.name));
  std::vector<std::string> flags;
  if (has_other_axes) flags.push_back(fmt::format("--collider-axes {}", preset.name));
  if (has_other_axes ? unit.name != preset.unit : found.has_other_unit)
    flags.push_back(fmt::format("--collider-unit {}", unit.name));
  found.words = fmt::format("{}", fmt::join(words, " and "));
  found.flags = fmt::format("{}", fmt::join(flags, " "));
  // The axes of a program explain another unit only if the program has one of its own.
  const bool is_explained = preset.unit != kLengthUnits.front().name;
  const bool are_two = flags.size() > 1 || (found.has_other_unit && has_other_axes && !is_explained);
  found.changes = are_two ? 1 + kFurtherFlag : 1;
  return found;
}

}  // namespace

std::vector<Reading> other_readings(const Convention& convention) {
  std::vector<Reading> found;
  std::vector<glm::dmat3> tried;
  for (const AxisPreset& preset : kAxisPresets) {
    const glm::dmat3 axes = axes_named(preset.name);
    if (std::ranges::find(tried, axes) != tried.end()) continue;
    tried.push_back(axes);
    for (const Unit& unit : kLengthUnits)
      if (Reading reading = with(convention, preset, unit); reading.convention != convention)
        found.push_back(std::move(reading));
  }
  std::array<std::size_t, 3> order = {0, 1, 2};
  while (std::ranges::next_permutation(order).found) {
    constexpr std::string_view kNames = "xyz";
    Reading other = {
        convention,
        fmt::format("with columns in the order {},{},{}", kNames[order[0]], kNames[order[1]], kNames[order[2]]),
        "put the columns in the order x,y,z", kOrderOfColumns};
    other.has_other_columns = true;
    for (std::size_t column = 0; column < 3; ++column)
      other.convention.axes[static_cast<int>(column)] = convention.axes[static_cast<int>(order[column])];
    found.push_back(std::move(other));
  }
  std::ranges::stable_sort(found, {}, [&](const Reading& reading) {
    const double told = reading.has_other_columns ? glm::determinant(convention.axes) : 1;
    return std::pair(reading.changes, told * glm::determinant(reading.convention.axes) < 0);
  });
  return found;
}

}  // namespace vestige
