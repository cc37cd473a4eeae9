#pragma once

#include <array>

#include "analysis/plot/studio/camera.hpp"
#include "analysis/plot/studio/surface.hpp"

namespace vestige::plot {

/// A side from which a body is viewed.
struct BodySide {
  const char* name;
  double azimuth_degrees;
};

/// Returns front and back, or left and right for a body that is longer than wide.
std::array<BodySide, 2> sides_of(const Surface& surface);

/// Returns the width of the body, seen from these sides.
double shown_width_of(const Surface& surface);

/// Returns the largest extent of the body, or 1 if the body has none.
double extent_of(const Surface& surface);

/// Returns a view that fills a cell of a page, with the body in its middle.
View view_of_side(const Surface& surface, const BodySide& side, double width_pt, double height_pt, double unit_per_pt);

}  // namespace vestige::plot
