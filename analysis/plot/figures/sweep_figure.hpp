#pragma once

#include <memory>

#include "analysis/plot/canvas/figure.hpp"
#include "analysis/plot/data/sweep_data.hpp"

namespace vestige::plot {

/// Draws the detection frequency over the number of colliders: the paper's Figure 2, with its three published points
/// beside the measured points.
std::unique_ptr<Figure> sweep_figure(Sweeps sweeps);

}  // namespace vestige::plot
