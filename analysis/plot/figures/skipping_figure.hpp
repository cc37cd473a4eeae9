#pragma once

#include <memory>

#include "analysis/plot/canvas/figure.hpp"
#include "analysis/plot/data/skipping_data.hpp"

namespace vestige::plot {

/// Draws, for each sweep, how many pairs of collider and triangle are left after each kind of skipping.
std::unique_ptr<Figure> skipping_figure(SkippingResult result);

}  // namespace vestige::plot
