#pragma once

#include "analysis/plot/canvas/canvas.hpp"

namespace vestige::plot {

/// The σ over which contacts are spread, as a share of the body's largest extent: 2.5 cm on an adult.
inline constexpr double kHeatSigma = 1.0 / 70;

/// Returns the colour of a density: 0 is skin without contacts, 1 the highest density. It becomes darker throughout.
Colour heat_ramp(double part);

/// A unit of area that suits a body, and the length of its side in metres.
struct AreaUnit {
  const char* name;
  double side_m;
};
AreaUnit unit_for(double extent_m);

/// Returns the end of a scale that begins at 0 and reaches at least `highest`.
double heat_bar_high(double highest);

/// Draws the key to a picture of contact density: from 0 to `high` contacts per unit of area, with its title, below
/// `top_left`.
void draw_heat_bar(Canvas& canvas, Place top_left, double height_pt, double high, double extent_m);

}  // namespace vestige::plot
