#pragma once

#include <memory>

#include "analysis/plot/canvas/figure.hpp"
#include "analysis/plot/data/growth_data.hpp"

namespace vestige::plot {

/// How cost grows: microseconds a frame against colliders and, beside it, against triangles, both axes logarithmic. A
/// colour for each detector and context; dashed where nothing is skipped and there is a line with skipping too.
std::unique_ptr<Figure> growth_figure(GrowthResult result);

}  // namespace vestige::plot
