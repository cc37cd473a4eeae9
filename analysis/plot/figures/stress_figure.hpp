#pragma once

#include <memory>

#include "analysis/plot/canvas/figure.hpp"
#include "analysis/plot/data/stress_data.hpp"

namespace vestige::plot {

/// Draws a heat map of errors, with a row for each family and magnitude, and a column for each detector and method.
std::unique_ptr<Figure> stress_figure(StressResult result);

}  // namespace vestige::plot
