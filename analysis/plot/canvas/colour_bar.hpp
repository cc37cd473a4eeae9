#pragma once

#include <string_view>
#include <vector>

#include "analysis/plot/canvas/axis.hpp"
#include "analysis/plot/canvas/canvas.hpp"

namespace vestige::plot {

/// Colours for 0..1.
using Ramp = Colour (*)(double part);

/// A key to `ramp`: `box` filled from low (bottom) to high (top), both labelled on its right, `title` above it.
void draw_colour_bar(Canvas& canvas, const Box& box, Ramp ramp, double low, double high, std::string_view title);

/// The same from 0 to `high`, labelled at `ticks`.
void draw_colour_bar(Canvas& canvas, const Box& box, Ramp ramp, const std::vector<Tick>& ticks, double high,
                     std::string_view title);

}  // namespace vestige::plot
