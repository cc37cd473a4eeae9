#pragma once

#include "analysis/plot/canvas/canvas.hpp"

namespace vestige::plot {

/// How far contacts are spread, in the body's largest extent: 2.5 cm for a grown person.
inline constexpr double kHeatSigma = 1.0 / 70;

/// From skin without contacts to the most, 0..1: darker throughout.
Colour heat_ramp(double part);

/// The unit of area that suits a body, in metres along its side.
struct AreaUnit {
  const char* name;
  double side_m;
};
AreaUnit unit_for(double extent_m);

/// Where a scale from 0 to at least `highest` ends.
double heat_bar_high(double highest);

/// The key to a picture of contacts' density: from 0 to `high` contacts per unit of area, below `top_left` with its
/// title.
void draw_heat_bar(Canvas& canvas, Place top_left, double height_pt, double high, double extent_m);

}  // namespace vestige::plot
