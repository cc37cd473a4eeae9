#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "traces/scene/avatar.hpp"

namespace vestige {

/// Triangles of a meshlet; only the last has fewer. With 16, bounding twice as many costs what it saves.
inline constexpr std::size_t kMeshletTriangles = 32;
static_assert(kMeshletTriangles % 16 == 0 && kMeshletTriangles <= 32);  // a bit each, and whole vectors
/// Nodes of one level that make a node of the next.
inline constexpr std::size_t kMeshletFanout = 8;

/// Where, in the bind pose, all vertices are that one palette entry moves: a box, in the units of `position_bind`.
struct RestBox {
  glm::vec3 centre;
  std::uint32_t entry;
  glm::vec3 half_extent;
  float padding;
};

/// An avatar's triangles in small patches, and a tree over them, by bisection of the rest pose: around the built-in
/// avatar, colliders meet half as many boxes of these as of meshopt_buildMeshlets' patches. Level 0 are the meshlets;
/// node i of a level holds the nodes kMeshletFanout * i and following of the level below; the last level is one node,
/// the whole avatar. It depends on nothing but the avatar.
class Meshlets {
 public:
  explicit Meshlets(const Avatar& avatar);

  std::size_t size() const { return (triangles_.size() + kMeshletTriangles - 1) / kMeshletTriangles; }

  /// Ascending. Every triangle is in exactly one meshlet.
  std::span<const std::uint32_t> triangles(std::size_t meshlet) const {
    return std::span(triangles_)
        .subspan(meshlet * kMeshletTriangles,
                 std::min(kMeshletTriangles, triangles_.size() - meshlet * kMeshletTriangles));
  }

  /// 0 for an avatar without triangles.
  std::size_t levels() const { return levels_.size(); }
  std::size_t nodes(std::size_t level) const { return levels_[level].first_box.size() - 1; }

  /// One for each palette entry that moves any of the node's vertices, by ascending entries. Empty where they would be
  /// more than bounding the node is worth: then nothing is known of it.
  std::span<const RestBox> rest_boxes(std::size_t level, std::size_t node) const {
    const Level& l = levels_[level];
    return std::span(l.boxes).subspan(l.first_box[node], l.first_box[node + 1] - l.first_box[node]);
  }

 private:
  struct Level {
    std::vector<std::size_t> first_box = {0};  ///< of each node, and the end
    std::vector<RestBox> boxes;
  };

  Level box_level(const Avatar& avatar, std::size_t triangles_a_node) const;

  std::vector<std::uint32_t> triangles_;  ///< meshlet by meshlet
  std::vector<Level> levels_;
};

}  // namespace vestige
