#pragma once

#include <vector>

#include "detector/frame.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige::test {

/// Returns an avatar of one rigid node with these triangles. Its texture coordinates are x and y.
inline Avatar rigid_avatar(const std::vector<glm::vec3>& vertices, const std::vector<glm::uvec3>& triangles) {
  Avatar avatar;
  avatar.nodes.resize(1);
  avatar.node_order = {0};
  avatar.palette.resize(1);
  avatar.position_bind = vertices;
  for (const glm::vec3& vertex : vertices) avatar.texture_coordinate.emplace_back(vertex.x, vertex.y);
  Influences rigid;
  rigid.weight[0] = 1;
  avatar.influences.assign(vertices.size(), rigid);
  avatar.triangles = triangles;
  avatar.joint_count = 1;
  return avatar;
}

/// Returns a frame in which `avatar` is at rest and one collider moves along each segment.
inline DetectorFrame frame_of(const Avatar& avatar, const std::vector<Segment>& segments) {
  DetectorFrame frame;
  frame.index = 1;
  frame.time_s = 0.01;
  frame.duration_s = 0.01;
  frame.segments = segments;
  frame.columns = segments.empty() ? 0 : segments.back().column + 1;
  std::vector<glm::dmat4> world;
  world_matrices(avatar, rest_pose(avatar), world);
  build_palette(avatar, world, glm::dvec3(0), frame.palette);
  return frame;
}

}  // namespace vestige::test
