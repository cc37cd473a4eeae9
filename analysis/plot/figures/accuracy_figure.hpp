#pragma once

#include <memory>

#include "analysis/plot/canvas/figure.hpp"
#include "analysis/plot/data/accuracy_data.hpp"

namespace vestige::plot {

/// Run time against error: for each scene, the share of true contact events that is missed over the run time that a
/// second of motion takes, a line for each detector and method through the rates of the trace. Where none is missed,
/// which a logarithm cannot show, each line has a lane of its own below the axis.
std::unique_ptr<Figure> accuracy_figure(AccuracyResult result);

}  // namespace vestige::plot
