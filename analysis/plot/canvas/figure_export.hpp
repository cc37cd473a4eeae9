#pragma once

#include <string>

#include "analysis/plot/canvas/figure.hpp"

namespace vestige::plot {

/// The figure as an SVG document, width and height in points. Needs no OpenGL.
std::string svg_of(const Figure& figure);

/// The figure as a PNG file at `kPrintDotsPerInch`. Throws `GlUnavailable`.
std::string png_of(const Figure& figure);

}  // namespace vestige::plot
