#include "analysis/stress/loose_triangles.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

namespace vestige {

namespace {

/// The matrices have translations only: nothing else moves a vertex whose bind position is 0.
std::vector<SkinMatrix> palette_of(std::span<const LooseTriangle> triangles) {
  std::vector<SkinMatrix> palette;
  palette.reserve(3 * triangles.size());
  const glm::vec4 zero(0);
  for (const LooseTriangle& triangle : triangles)
    for (const glm::vec3& corner : triangle) palette.push_back({{zero, zero, zero, glm::vec4(corner, 0.0F)}});
  return palette;
}

}  // namespace

Avatar loose_triangles(std::size_t count) {
  if (count > kMostLooseTriangles)
    throw std::invalid_argument(fmt::format("{} loose triangles are more than {}", count, kMostLooseTriangles));
  const std::size_t corners = 3 * count;
  Avatar avatar;
  avatar.nodes.resize(corners);
  avatar.palette.resize(corners);
  avatar.position_bind.assign(corners, glm::vec3(0));
  avatar.texture_coordinate.reserve(corners);
  avatar.influences.resize(corners);
  avatar.node_order.reserve(corners);
  for (std::size_t i = 0; i < corners; ++i) {
    avatar.node_order.push_back(static_cast<int>(i));
    avatar.palette[i].node = static_cast<int>(i);
    avatar.influences[i].palette[0] = static_cast<std::uint16_t>(i);
    avatar.influences[i].weight[0] = 1;
    avatar.texture_coordinate.emplace_back(i % 3 == 1 ? 1.0F : 0.0F, i % 3 == 2 ? 1.0F : 0.0F);
  }
  avatar.triangles.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto first = static_cast<glm::uint>(3 * i);
    avatar.triangles.emplace_back(first, first + 1, first + 2);
  }
  avatar.joint_count = corners;
  return avatar;
}

DetectorFrame loose_frame(std::span<const LooseTriangle> before, std::span<const LooseTriangle> now,
                          std::vector<Segment> segments) {
  DetectorFrame frame;
  frame.index = 1;
  frame.time_s = 0.01;
  frame.duration_s = 0.01;
  frame.columns = segments.empty() ? 0 : segments.back().column + 1;
  frame.palette = palette_of(now);
  frame.palette_before = palette_of(before);
  frame.segments = std::move(segments);
  return frame;
}

}  // namespace vestige
