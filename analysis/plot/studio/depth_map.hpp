#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "analysis/plot/studio/camera.hpp"
#include "analysis/plot/studio/surface.hpp"

namespace vestige::plot {

/// What is nearest to the viewer at one place of a picture.
struct Sample {
  static constexpr std::uint32_t kNothing = std::numeric_limits<std::uint32_t>::max();

  std::uint32_t triangle = kNothing;
  float u = 0;  ///< weights of the triangle's second and third vertex
  float v = 0;
  float depth = -std::numeric_limits<float>::infinity();  ///< towards the viewer
};

/// Draws a surface by a depth buffer, on the CPU: which triangle is seen where is then known exactly, on every machine
/// alike and without OpenGL. Samples lie at the middle of the view's dots; rows from the top.
std::vector<Sample> draw_surface(const Surface& surface, const View& view);

}  // namespace vestige::plot
