#pragma once

#include <memory>

#include "analysis/plot/canvas/figure.hpp"
#include "analysis/plot/figures/timeline_figure.hpp"

namespace vestige::plot {

/// What each actuator was told, as an area, and what was measured at its pin, as a line over it. The board counts its
/// time from its own start, so `measured` is shifted until the first actuator that goes on does so in both at once.
/// Throws `Error` where the two have other numbers of actuators, or nothing ever goes on in one; `name` stands in it.
std::unique_ptr<Figure> measured_figure(Timeline commanded, Timeline measured, const std::string& name);

}  // namespace vestige::plot
