#include "analysis/plot/canvas/duty_raster.hpp"

#include <algorithm>

#include "analysis/colours/palette.hpp"

namespace vestige::plot {

Raster duty_raster(std::span<const std::uint8_t> duty, std::size_t columns, std::size_t height_dots,
                   const DutyColour& colour) {
  constexpr std::size_t kParted = 8;
  const std::size_t actuators = duty.size() / columns;
  Raster result(columns, height_dots, kWhite);
  for (std::size_t row = 0; row < height_dots; ++row) {
    const std::size_t first = row * actuators / height_dots;
    const std::size_t next = (row + 1) * actuators / height_dots;
    if (next > first && next < actuators && height_dots / actuators >= kParted) continue;
    for (std::size_t column = 0; column < columns; ++column) {
      std::size_t highest = first;
      for (std::size_t actuator = first; actuator < next; ++actuator)
        if (duty[actuator * columns + column] > duty[highest * columns + column]) highest = actuator;
      result.at(column, row) = colour(highest, duty[highest * columns + column]);
    }
  }
  return result;
}

}  // namespace vestige::plot
