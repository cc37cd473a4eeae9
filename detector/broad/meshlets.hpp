#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "traces/scene/avatar.hpp"

namespace vestige {

/// Triangles of a meshlet; only the last meshlet has fewer. With 16 triangles, the cost of bounding twice as many
/// meshlets equals the savings.
inline constexpr std::size_t kMeshletTriangles = 32;
static_assert(kMeshletTriangles % 16 == 0 && kMeshletTriangles <= 32);  // a bit each, and whole vectors
/// Returns a bit for each of a meshlet's first `triangles` triangles.
constexpr std::uint32_t bits_of(std::size_t triangles) {
  return static_cast<std::uint32_t>((std::uint64_t{1} << triangles) - 1);
}
/// Number of child nodes of a node.
inline constexpr std::size_t kMeshletFanout = 8;

/// A box around all vertices that one palette entry moves, in the bind pose and in the units of `position_bind`.
struct RestBox {
  glm::vec3 centre;
  std::uint32_t entry;
  glm::vec3 half_extent;
  float padding;
};

/// An avatar's triangles in small patches (meshlets), and a tree over them, built by bisection of the rest pose. Around
/// the built-in avatar, colliders meet half as many boxes of these meshlets as of meshopt_buildMeshlets' patches.
///
/// Level 0 has the meshlets. Node i of a level has the nodes kMeshletFanout * i and following of the level below as its
/// children. The last level is one node, the whole avatar. The tree depends only on the avatar.
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

  /// Number of levels; 0 for an avatar without triangles.
  std::size_t levels() const { return levels_.size(); }
  std::size_t nodes(std::size_t level) const { return levels_[level].first_box.size() - 1; }

  /// Returns one box for each palette entry that moves any of the node's vertices, by ascending entries. The list is
  /// empty if it would be too long to be worth its cost. Then the node has no bounds.
  std::span<const RestBox> rest_boxes(std::size_t level, std::size_t node) const {
    const Level& l = levels_[level];
    return std::span(l.boxes).subspan(l.first_box[node], l.first_box[node + 1] - l.first_box[node]);
  }

 private:
  struct Level {
    std::vector<std::size_t> first_box = {0};  ///< index of the first box of each node, and the end
    std::vector<RestBox> boxes;
  };

  Level box_level(const Avatar& avatar, std::size_t triangles_a_node) const;

  std::vector<std::uint32_t> triangles_;  ///< meshlet by meshlet
  std::vector<Level> levels_;
};

}  // namespace vestige
