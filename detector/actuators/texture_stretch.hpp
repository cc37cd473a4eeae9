#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <limits>

namespace vestige {

/// An interval of x; empty if low > high.
struct Stretch {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

/// Returns the x interval of the part of a triangle with low <= y <= high: of the corners in that range, and of the
/// edges where they leave it. In a row of texels, the triangle touches the texels that this interval touches
/// (conservative rasterisation: Akenine-Möller & Aila 2005).
inline Stretch stretch_within(const std::array<glm::dvec2, 3>& corners, double low, double high) {
  Stretch stretch;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec2& from = corners[i];
    const glm::dvec2& to = corners[(i + 1) % corners.size()];
    if (from.y >= low && from.y <= high) stretch.add(from.x);
    for (const double y : {low, high})
      if ((from.y < y) != (to.y < y))
        stretch.add(glm::mix(from.x, to.x, std::clamp((y - from.y) / (to.y - from.y), 0.0, 1.0)));
  }
  return stretch;
}

/// Calls `visit(column, row)` for every texel that a triangle touches, including its edges, without wrapping. `corners`
/// are in texels, finite and not far apart.
template <typename Visit>
void for_touched_texels(const std::array<glm::dvec2, 3>& corners, const Visit& visit) {
  const auto texel_of = [](double value) { return static_cast<std::int64_t>(std::floor(value)); };
  const auto [low, high] = std::minmax({corners[0].y, corners[1].y, corners[2].y});
  for (std::int64_t row = texel_of(low); row <= texel_of(high); ++row) {
    const auto y = static_cast<double>(row);
    const Stretch stretch = stretch_within(corners, y, y + 1);
    if (stretch.low > stretch.high) continue;
    for (std::int64_t column = texel_of(stretch.low); column <= texel_of(stretch.high); ++column) visit(column, row);
  }
}

/// Returns whether a triangle's texture coordinates are finite and cover a texture of this size at most once. Then its
/// texels can be enumerated.
inline bool fits_texture(const std::array<glm::dvec2, 3>& corners, const glm::dvec2& size) {
  constexpr double kFarthest = 1 << 30;
  const glm::dvec2 low = glm::min(glm::min(corners[0], corners[1]), corners[2]);
  const glm::dvec2 high = glm::max(glm::max(corners[0], corners[1]), corners[2]);
  return std::ranges::all_of(
             corners, [](const glm::dvec2& p) { return std::abs(p.x) < kFarthest && std::abs(p.y) < kFarthest; }) &&
         high.x - low.x <= size.x && high.y - low.y <= size.y;
}

}  // namespace vestige
