#pragma once

#include <memory>

#include "analysis/plot/canvas/figure.hpp"
#include "analysis/plot/data/growth_data.hpp"

namespace vestige::plot {

/// Draws how cost grows: microseconds of a frame, in panels side by side. Both axes are logarithmic. Each detector with
/// its context has a colour. A line without skipping is dashed if there is also a line with skipping, and dotted if
/// only the first of several people has colliders.
std::unique_ptr<Figure> growth_figure(GrowthResult result);

}  // namespace vestige::plot
