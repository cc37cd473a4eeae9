#include "analysis/mapping/skin_patches.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace vestige {

namespace {

/// Returns 1 … most, and `most` for NaN.
std::uint32_t pieces(double length_in_steps, double most) {
  const double wanted = std::ceil(length_in_steps);
  if (!(wanted < most)) return static_cast<std::uint32_t>(most);
  return static_cast<std::uint32_t>(std::max(wanted, 1.0));
}

}  // namespace

SkinPatches patches_of_length(const BodySurface& surface, std::uint32_t triangle, double step_m) {
  return {triangle, pieces(surface.longest_edge_m(triangle) / step_m, 64)};
}

SkinPatches patches_of_body(const BodySurface& surface, std::uint32_t triangle, double step) {
  constexpr double kShare = 0.004;
  return patches_of_length(surface, triangle, step * kShare * surface.bounds().longest_side());
}

SkinPatches patches_of_texels(const BodySurface& surface, std::uint32_t triangle, const glm::dvec2& map_size,
                              double step) {
  const auto [a, b, c] = surface.texels(triangle, map_size);
  return {triangle, pieces(std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)}) / step, 512)};
}

}  // namespace vestige
