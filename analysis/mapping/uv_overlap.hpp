#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "traces/scene/avatar.hpp"

namespace vestige {

/// How an avatar's triangles share a texture. Where several triangles overlap, an actuator map cannot tell them apart.
struct UvCoverage {
  std::uint32_t side = 0;  ///< texels on each side
  /// Number of triangles over each texel's centre, at most 255; row by row from the top (v = 0).
  std::vector<std::uint8_t> layers;
  std::size_t covered_texels = 0;  ///< texels covered by one triangle or more
  std::size_t overlap_texels = 0;  ///< texels covered by two or more
};

/// Counts the triangles over each texel of a `side` x `side` texture. Coordinates outside [0, 1] are wrapped as an
/// actuator map wraps them (detector/CONTRACT.md, 8). A texel belongs to the triangles that its centre lies in, and
/// each triangle counts once. A texel whose centre lies on a common edge belongs to one of the edge's two triangles.
/// Triangles without area in UV space cover nothing. A triangle that is wider or higher than the texture counts for one
/// turn around it. So the time is bounded by triangles x covered texels.
UvCoverage uv_coverage(const Avatar& avatar, std::uint32_t side);

}  // namespace vestige
