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

/// Skins the triangles of one meshlet at once, to the bits of `skin_vertex`.
class MeshletSkin {
 public:
  /// Keeps references to both.
  MeshletSkin(const Avatar& avatar, const Meshlets& meshlets);

  /// Places beyond the meshlet's last triangle repeat its first. Every number of the palette is finite.
  void skin(std::size_t meshlet, std::span<const SkinMatrix> palette, MeshletCorners& out) const;

 private:
  struct Block {
    std::size_t first_number = 0;
    std::size_t first_entry = 0;
    std::size_t entries = 0;  ///< 0: too many to be worth it
  };

  const Avatar& avatar_;
  const Meshlets& meshlets_;
  std::vector<Block> blocks_;
  std::vector<float> numbers_;  ///< of each block: bind x, y, z of all corners, then each entry's weights
  std::vector<std::uint32_t> entries_;
};

}  // namespace vestige
