#pragma once

#include <array>

#include "analysis/plot/studio/camera.hpp"
#include "analysis/plot/studio/surface.hpp"

namespace vestige::plot {

/// From where a body is looked at.
struct BodySide {
  const char* name;
  double azimuth_degrees;
};

/// Front and back; of a body that is longer than wide, both sides.
std::array<BodySide, 2> sides_of(const Surface& surface);

/// How wide the body is, seen from them.
double shown_width_of(const Surface& surface);

/// Its largest extent, above 0.
double extent_of(const Surface& surface);

/// The view that fills a cell of a page, the body in its middle.
View view_of_side(const Surface& surface, const BodySide& side, double width_pt, double height_pt, double unit_per_pt);

}  // namespace vestige::plot
