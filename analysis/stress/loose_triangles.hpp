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

/// The most triangles that an avatar can have if every corner is its own joint: palette indices have 16 bits.
inline constexpr std::size_t kMostLooseTriangles = 65535 / 3;

/// Returns an avatar whose triangles share nothing, so that arbitrary triangles can go through any detector, including
/// its shaders and its skinning. Corner c of triangle i is vertex and joint 3 i + c, with its bind position at 0.
/// Texture coordinates are (0, 0), (1, 0) and (0, 1). Throws `std::invalid_argument` if `count` is above
/// `kMostLooseTriangles`.
Avatar loose_triangles(std::size_t count);

/// Returns a frame of 10 ms in which triangle i of `loose_triangles(now.size())` moves from `before[i]` to `now[i]`.
/// The skinned vertices have exactly these bits, except that -0 becomes 0. `before` and `now` must have equal length.
/// The columns of `segments` must ascend.
DetectorFrame loose_frame(std::span<const LooseTriangle> before, std::span<const LooseTriangle> now,
                          std::vector<Segment> segments);

}  // namespace vestige
