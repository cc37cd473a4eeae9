#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "detector/broad/meshlets.hpp"
#include "detector/decision.hpp"
#include "detector/skinning.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige {

/// The skinned corners of a meshlet's triangles: axis, corner, triangle.
struct MeshletCorners {
  alignas(64) std::array<std::array<std::array<float, kMeshletTriangles>, 3>, 3> position;

  glm::vec3 at(std::size_t corner, std::size_t triangle) const {
    return {position[0][corner][triangle], position[1][corner][triangle], position[2][corner][triangle]};
  }
  Corners corners(std::size_t triangle) const {
    return {glm::dvec3(at(0, triangle)), glm::dvec3(at(1, triangle)), glm::dvec3(at(2, triangle))};
  }
};

/// Skins all triangles of one meshlet at once, with the same bits as `skin_vertex`.
class MeshletSkin {
 public:
  /// Keeps references to `avatar` and `meshlets`.
  MeshletSkin(const Avatar& avatar, const Meshlets& meshlets);

  /// Slots after the meshlet's last triangle repeat its first triangle. All numbers of the palette must be finite.
  void skin(std::size_t meshlet, std::span<const SkinMatrix> palette, MeshletCorners& out) const;

 private:
  struct Block {
    std::size_t first_number = 0;
    std::size_t first_entry = 0;
    std::size_t entries = 0;  ///< 0: the meshlet is skinned vertex by vertex
  };

  const Avatar& avatar_;
  const Meshlets& meshlets_;
  std::vector<Block> blocks_;
  std::vector<float> numbers_;  ///< for each block: bind x, y, z of all corners, then the weights of each entry
  std::vector<std::uint32_t> entries_;
};

}  // namespace vestige
