#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "detector/frame.hpp"
#include "tests/support/small_avatar.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige::test {

/// Returns triangles on top of each other, a millimetre apart.
inline Avatar pile_of(std::uint32_t triangle_count) {
  std::vector<glm::vec3> vertices;
  std::vector<glm::uvec3> triangles;
  for (std::uint32_t i = 0; i < triangle_count; ++i) {
    for (const glm::vec2 corner : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(0, 1)})
      vertices.emplace_back(corner.x, corner.y, 0.001F * static_cast<float>(i));
    triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
  }
  return rigid_avatar(vertices, triangles);
}

/// Returns a frame whose segments meet every triangle of a pile that rests, the last of them first.
inline DetectorFrame frame_through(const Avatar& pile, std::uint32_t segment_count) {
  std::vector<Segment> segments;
  for (std::uint32_t i = 0; i < segment_count; ++i) {
    const float x = 0.4F * static_cast<float>(i) / static_cast<float>(segment_count);
    segments.push_back({i, {x, 0.3F, 2}, {x, 0.3F, -1}});
  }
  DetectorFrame frame = frame_of(pile, segments);
  frame.palette_before = frame.palette;
  return frame;
}

}  // namespace vestige::test
