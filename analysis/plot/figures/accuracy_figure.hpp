#pragma once

#include <memory>

#include "analysis/plot/canvas/figure.hpp"
#include "analysis/plot/data/accuracy_data.hpp"

namespace vestige::plot {

/// Draws error against run time for each scene: the share of true contact events that is missed, over the run time that
/// a second of motion takes. Each detector with its method is a line through the rates of the trace. A logarithmic axis
/// cannot show zero, so for points without missed events each line has a lane of its own below the axis.
std::unique_ptr<Figure> accuracy_figure(AccuracyResult result);

}  // namespace vestige::plot
