#pragma once

#include <memory>

#include "analysis/plot/canvas/figure.hpp"
#include "analysis/plot/figures/timeline_figure.hpp"

namespace vestige::plot {

/// Draws what each actuator was told as an area, and what was measured at its pin as a line over it. The board's clock
/// begins at the board's own start. So `measured` is shifted until the first actuator that switches on does so in both
/// at the same time. Throws `Error`, with `name` in it, if the numbers of actuators differ, or if in one of the two
/// nothing ever switches on.
std::unique_ptr<Figure> measured_figure(Timeline commanded, Timeline measured, const std::string& name);

}  // namespace vestige::plot
