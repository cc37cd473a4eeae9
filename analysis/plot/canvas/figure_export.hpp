#pragma once

#include <memory>
#include <string>

#include "analysis/plot/canvas/figure.hpp"

namespace vestige::plot {

/// Returns the figure as an SVG document with width and height in points. Does not need OpenGL.
std::string svg_of(const Figure& figure);

/// Draws figures as pictures, one after the other, in one OpenGL context.
class FigureScreen {
 public:
  /// Throws `GlUnavailable` if there is no OpenGL context.
  explicit FigureScreen(double dots_per_inch);
  ~FigureScreen();
  FigureScreen(const FigureScreen&) = delete;
  FigureScreen& operator=(const FigureScreen&) = delete;

  Raster raster_of(const Figure& figure);
  /// Returns the picture as a PNG file.
  std::string png_of(const Figure& figure);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// Returns the figure as a PNG file at `kPrintDotsPerInch`. Throws `GlUnavailable` if there is no OpenGL context.
std::string png_of(const Figure& figure);

}  // namespace vestige::plot
