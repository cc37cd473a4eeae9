#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "analysis/plot/studio/camera.hpp"
#include "analysis/plot/studio/surface.hpp"

namespace vestige::plot {

/// The point of the surface that is nearest to the viewer at one place of a picture.
struct Sample {
  static constexpr std::uint32_t kNothing = std::numeric_limits<std::uint32_t>::max();

  std::uint32_t triangle = kNothing;
  float u = 0;  ///< weights of the triangle's second and third vertex
  float v = 0;
  float depth = -std::numeric_limits<float>::infinity();  ///< larger is nearer to the viewer
};

/// Draws a surface with a depth buffer on the CPU. So the visible triangle of every place is known exactly, equally on
/// every machine, and without OpenGL. Samples lie at the middle of the view's dots. Rows begin at the top.
std::vector<Sample> draw_surface(const Surface& surface, const View& view);

}  // namespace vestige::plot
