#pragma once

#include <string_view>
#include <vector>

#include "analysis/plot/canvas/axis.hpp"
#include "analysis/plot/canvas/canvas.hpp"

namespace vestige::plot {

/// Returns the colour of a value in 0..1.
using Ramp = Colour (*)(double part);

/// Draws a key to `ramp`: `box` filled from low (bottom) to high (top), with both values on its right and `title` above
/// it.
void draw_colour_bar(Canvas& canvas, const Box& box, Ramp ramp, double low, double high, std::string_view title);

/// Draws a key from 0 to `high`, labelled at `ticks`.
void draw_colour_bar(Canvas& canvas, const Box& box, Ramp ramp, const std::vector<Tick>& ticks, double high,
                     std::string_view title);

}  // namespace vestige::plot
