#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include "analysis/plot/canvas/canvas.hpp"

namespace vestige::plot {

inline constexpr int kFullDuty = 255;

/// Returns the colour of a duty, 0 … `kFullDuty`, of an actuator, counted from 0.
using DutyColour = std::function<Colour(std::size_t actuator, std::uint8_t duty)>;

/// Draws a line for each actuator, the first at the top, in a picture `height_dots` high. `duty` has `columns` duties
/// for each actuator. A white dot parts lines that are high enough for it. If there are more actuators than dots,
/// several share one, which shows their highest duty.
Raster duty_raster(std::span<const std::uint8_t> duty, std::size_t columns, std::size_t height_dots,
                   const DutyColour& colour);

}  // namespace vestige::plot
