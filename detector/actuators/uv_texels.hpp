#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/vec2.hpp>
#include <limits>

namespace vestige {

/// Visits the texels of a texture of width x height whose centres lie in a triangle, row by row. Texels wrap as in an
/// actuator map (detector/CONTRACT.md, 8). The function calls `run(row, column, count)` for each run of texels; a run
/// that reaches the width continues at column 0. `corners` are in texels and may have any finite values. A texel on a
/// common edge belongs to only one of the two triangles. For a triangle wider or higher than the texture, only one turn
/// around the texture counts.
template <typename Run>
void for_texels_of(const std::array<glm::dvec2, 3>& corners, std::uint32_t width, std::uint32_t height, Run&& run) {
  const auto wrap = [](double texel, std::uint32_t side) {
    const double turn = side;
    // Coordinates beyond 2^53 texels all fall on the first or the last texel.
    return std::min(static_cast<std::uint32_t>(texel - turn * std::floor(texel / turn)), side - 1);
  };
  const auto [low, high] = std::minmax({corners[0].y, corners[1].y, corners[2].y});
  // Rows whose middle lies in [low, high).
  const double first_row = std::ceil(low - 0.5);
  const double rows = std::min<double>(std::ceil(high - 0.5) - first_row, height);
  for (int k = 0; k < static_cast<int>(rows); ++k) {
    // The outline crosses the row's middle at `begin` (included) and `end` (excluded). Two triangles with a common edge
    // compute the same crossing.
    const double y = first_row + k + 0.5;
    double begin = std::numeric_limits<double>::infinity();
    double end = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 3; ++i) {
      const bool upwards = corners[i].y < corners[(i + 1) % 3].y;
      const glm::dvec2& a = corners[upwards ? i : (i + 1) % 3];
      const glm::dvec2& b = corners[upwards ? (i + 1) % 3 : i];
      if (y < a.y || y >= b.y) continue;
      const double x = a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x);
      begin = std::min(begin, x);
      end = std::max(end, x);
    }
    const double first = std::ceil(begin - 0.5);
    const double columns = std::min<double>(std::ceil(end - 0.5) - first, width);
    if (columns > 0) run(wrap(first_row + k, height), wrap(first, width), static_cast<std::uint32_t>(columns));
  }
}

}  // namespace vestige
