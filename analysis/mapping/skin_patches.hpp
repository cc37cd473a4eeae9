#pragma once

#include <cstddef>
#include <cstdint>
#include <numbers>

#include "analysis/mapping/body_surface.hpp"

namespace vestige {

/// A triangle cut into n x n equal patches. An upward patch (i, j) points up like the triangle itself, with i + j < n.
/// Its first corner is where the triangle's second and third corners weigh i / n and j / n. A downward patch (i, j)
/// lies across the long side of the upward patch (i, j), with i + j < n - 1.
struct SkinPatches {
  std::uint32_t triangle = 0;
  std::uint32_t n = 1;

  std::size_t count() const { return std::size_t{n} * n; }

  /// Calls `visit` with the middle of every patch. Goes through the rows i in order. Within a row, upward and downward
  /// patches alternate.
  template <typename Visit>
  void for_each(const Visit& visit) const {
    for (std::uint32_t i = 0; i < n; ++i)
      for (std::uint32_t j = 0; i + j < n; ++j) {
        visit(point((i + 1.0 / 3) / n, (j + 1.0 / 3) / n));
        if (i + j + 1 < n) visit(point((i + 2.0 / 3) / n, (j + 2.0 / 3) / n));
      }
  }

  SkinPoint point(double u, double v) const { return {triangle, {1 - u - v, u, v}}; }

  /// Returns the index at which `for_each` visits the upward patch (i, j). The downward patch (i, j) follows it.
  std::size_t upward(std::uint32_t i, std::uint32_t j) const {
    // Row r has 2 (n - r) - 1 patches.
    return std::size_t{i} * (2 * std::size_t{n} - i) + 2 * std::size_t{j};
  }
};

/// Returns the least step of 1, √2, 2, … with which all triangles together have at most `most` patches; 1024 if there
/// is none. A body of many large triangles would otherwise take minutes. `patches_of` returns the patches of a triangle
/// with a step.
template <typename PatchesOf>
double affordable_step(const BodySurface& surface, double most, const PatchesOf& patches_of) {
  double step = 1;
  for (int round = 0; round < 20; ++round, step *= std::numbers::sqrt2) {
    double total = 0;
    for (std::uint32_t i = 0; i < surface.avatar().triangles.size(); ++i)
      total += static_cast<double>(patches_of(i, step).count());
    if (total <= most) break;
  }
  return step;
}

/// Cuts so finely that no patch is longer than `step_m`, but into at most 64 x 64 patches.
SkinPatches patches_of_length(const BodySurface& surface, std::uint32_t triangle, double step_m);

/// Cuts so finely that no patch is longer than 0.4 % of the body's longest side times `step`, but into at most 64 x 64
/// patches. 0.4 % is 7 mm on an adult.
SkinPatches patches_of_body(const BodySurface& surface, std::uint32_t triangle, double step = 1);

/// Cuts so finely that no patch is longer than `step` texels of a map of this size, but into at most 512 x 512 patches.
SkinPatches patches_of_texels(const BodySurface& surface, std::uint32_t triangle, const glm::dvec2& map_size,
                              double step);

}  // namespace vestige
