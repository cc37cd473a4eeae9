#pragma once

#include <memory>

#include "analysis/plot/canvas/figure.hpp"
#include "analysis/plot/data/latency_data.hpp"
#include "analysis/plot/data/stage_data.hpp"

namespace vestige::plot {

/// Draws where the time of a frame goes: a bar for each series and number of colliders, whose parts are the stages'
/// shares. Detectors differ by a factor of 1000, so that only shares compare; microseconds are written.
std::unique_ptr<Figure> stage_figure(StageResult result);

/// Draws where the time of a live session goes: for each stage from the arrival of input to the motor, which share of
/// the frames took up to some time.
std::unique_ptr<Figure> latency_figure(LatencyResult result);

}  // namespace vestige::plot
