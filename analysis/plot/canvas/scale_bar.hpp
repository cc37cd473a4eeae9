#pragma once

#include "analysis/plot/canvas/canvas.hpp"

namespace vestige::plot {

/// Draws a bar of a round length, at most `most_pt` long, that begins at `left`. Its length is written on its right.
/// `metre_per_pt` is the drawing's scale.
void draw_scale_bar(Canvas& canvas, Place left, double metre_per_pt, double most_pt);

}  // namespace vestige::plot
