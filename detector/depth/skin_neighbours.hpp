#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "traces/scene/avatar.hpp"

namespace vestige {

/// The triangles around each vertex of an avatar. Vertices at one place of the bind pose count as one: a seam of the
/// texture does not part the skin.
class SkinNeighbours {
 public:
  explicit SkinNeighbours(const Avatar& avatar);

  /// Returns the vertex that stands for all vertices at the place of `vertex`.
  std::uint32_t welded(std::uint32_t vertex) const { return welded_[vertex]; }
  /// Returns the triangles with a corner at the place of `vertex`, ascending.
  std::span<const std::uint32_t> triangles_around(std::uint32_t vertex) const {
    const std::uint32_t place = welded_[vertex];
    return std::span(triangles_).subspan(first_[place], first_[place + 1] - first_[place]);
  }

 private:
  std::vector<std::uint32_t> welded_;
  std::vector<std::size_t> first_;  ///< of each vertex's triangles, and the end
  std::vector<std::uint32_t> triangles_;
};

}  // namespace vestige
