#pragma once

#include <cstddef>
#include <cstdint>

#include "analysis/mapping/body_surface.hpp"

namespace vestige {

/// A triangle cut into n x n equal ones. Patch (i, j) of those that point up like the triangle itself has its first
/// corner where the triangle's second and third weigh i / n and j / n, with i + j < n; one that points down lies over
/// the long side of the upward one of the same numbers, with i + j < n - 1.
struct SkinPatches {
  std::uint32_t triangle = 0;
  std::uint32_t n = 1;

  std::size_t count() const { return std::size_t{n} * n; }

  /// Calls `visit` with the middle of every patch: row i by row, upward ones and downward ones alternating.
  template <typename Visit>
  void for_each(const Visit& visit) const {
    for (std::uint32_t i = 0; i < n; ++i)
      for (std::uint32_t j = 0; i + j < n; ++j) {
        visit(point((i + 1.0 / 3) / n, (j + 1.0 / 3) / n));
        if (i + j + 1 < n) visit(point((i + 2.0 / 3) / n, (j + 2.0 / 3) / n));
      }
  }

  SkinPoint point(double u, double v) const { return {triangle, {1 - u - v, u, v}}; }

  /// Where `for_each` comes to the upward patch (i, j); the downward one follows it.
  std::size_t upward(std::uint32_t i, std::uint32_t j) const {
    // Row r has 2 (n - r) - 1 patches.
    return std::size_t{i} * (2 * std::size_t{n} - i) + 2 * std::size_t{j};
  }
};

/// So fine that no patch is longer than `step_m`, to 64 x 64.
SkinPatches patches_of_length(const BodySurface& surface, std::uint32_t triangle, double step_m);

/// So fine that no patch is longer than 0.4 % of the body's longest side, times `step`: 7 mm of a grown person.
SkinPatches patches_of_body(const BodySurface& surface, std::uint32_t triangle, double step = 1);

/// So fine that no patch is longer than `step` texels of a map of this size, to 512 x 512.
SkinPatches patches_of_texels(const BodySurface& surface, std::uint32_t triangle, const glm::dvec2& map_size,
                              double step);

}  // namespace vestige
