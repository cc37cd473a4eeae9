#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "traces/scene/avatar.hpp"

namespace vestige {

/// How an avatar's triangles share a texture: where several lie upon each other, an actuator map cannot tell them
/// apart.
struct UvCoverage {
  std::uint32_t side = 0;  ///< texels a side
  std::vector<std::uint8_t>
      layers;                      ///< triangles over each texel's centre, row by row from the top (v = 0), 255 at most
  std::size_t covered_texels = 0;  ///< by one triangle or more
  std::size_t overlap_texels = 0;  ///< by two or more
};

/// Counts over a texture of `side` x `side` texels, coordinates outside [0, 1] wrapped as an actuator map wraps them
/// (detector/CONTRACT.md, 8). A texel belongs to the triangles that its centre lies in, each counted once; on a common
/// edge, to one of the two. Triangles without area in UV space cover nothing. Of a triangle that is wider or higher
/// than the texture, one turn around it is counted: the time is bounded by triangles x texels covered.
UvCoverage uv_coverage(const Avatar& avatar, std::uint32_t side);

}  // namespace vestige
