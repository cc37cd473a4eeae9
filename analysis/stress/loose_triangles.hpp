#pragma once

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "detector/frame.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige {

/// The corners of a triangle, metres.
using LooseTriangle = std::array<glm::vec3, 3>;

/// So many triangles can an avatar have whose every corner is a joint of its own: palette indices have 16 bits.
inline constexpr std::size_t kMostLooseTriangles = 65535 / 3;

/// An avatar of triangles that share nothing, so that any triangles whatever can go through any detector, its shaders
/// and its skinning included: corner c of triangle i is vertex and joint 3 i + c, with its bind position at 0. Texture
/// coordinates are (0, 0), (1, 0) and (0, 1). Throws `std::invalid_argument` above `kMostLooseTriangles`.
Avatar loose_triangles(std::size_t count);

/// The frame of 10 ms in which triangle i of `loose_triangles(now.size())` moves from `before[i]` to `now[i]`: skinned
/// vertices have exactly these bits, but for -0, which becomes 0. `before` and `now` are equally long; `segments` have
/// ascending columns.
Frame loose_frame(std::span<const LooseTriangle> before, std::span<const LooseTriangle> now,
                  std::vector<Segment> segments);

}  // namespace vestige
