#include "detector/depth/skin_neighbours.hpp"

#include <cstddef>
#include <numeric>
#include <utility>

#include "traces/scene/welding.hpp"

namespace vestige {

namespace {

/// Calls take(place) for each distinct place that a triangle has a corner at.
template <typename Take>
void for_each_place(const std::vector<std::uint32_t>& welded, const glm::uvec3& corner, const Take& take) {
  const std::uint32_t a = welded[corner.x];
  const std::uint32_t b = welded[corner.y];
  const std::uint32_t c = welded[corner.z];
  take(a);
  if (b != a) take(b);
  if (c != a && c != b) take(c);
}

}  // namespace

SkinNeighbours::SkinNeighbours(const Avatar& avatar)
    : welded_(weld_places(avatar.position_bind)), first_(avatar.position_bind.size() + 1, 0) {
  for (const glm::uvec3& corner : avatar.triangles)
    for_each_place(welded_, corner, [&](std::uint32_t place) { ++first_[place + 1]; });
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  triangles_.resize(first_.back());
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  for (std::uint32_t i = 0; i < avatar.triangles.size(); ++i)
    for_each_place(welded_, avatar.triangles[i], [&](std::uint32_t place) { triangles_[next[place]++] = i; });
}

}  // namespace vestige
