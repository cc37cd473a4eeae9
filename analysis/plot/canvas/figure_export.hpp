#pragma once

#include <string>

#include "analysis/plot/canvas/figure.hpp"

namespace vestige::plot {

/// Returns the figure as an SVG document with width and height in points. Does not need OpenGL.
std::string svg_of(const Figure& figure);

/// Returns the figure as a PNG file at `kPrintDotsPerInch`. Throws `GlUnavailable` if there is no OpenGL context.
std::string png_of(const Figure& figure);

}  // namespace vestige::plot
