#include "detector/broad/meshlets.hpp"

#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/mat4x4.hpp>
#include <limits>
#include <numeric>

#include "detector/skinning.hpp"
#include "traces/scene/pose.hpp"

namespace vestige {

namespace {

/// A node with more palette entries has no boxes. Otherwise a hostile file could make the boxes take more memory than
/// its mesh.
constexpr std::size_t kMostBoxes = 256;

double finite_or_zero(double x) {
  return std::isfinite(x) ? x : 0.0;
}

/// Returns the approximate position of each triangle in the rest pose. Parts that share a place in the bind pose can be
/// apart in the world.
std::vector<glm::dvec3> rest_centres(const Avatar& avatar) {
  std::vector<glm::dmat4> world;
  std::vector<SkinMatrix> palette;
  std::vector<glm::vec3> vertices;
  world_matrices(avatar, rest_pose(avatar), world);
  build_palette(avatar, world, glm::dvec3(0), palette);
  skin_vertices(avatar, palette, vertices);
  std::vector<glm::dvec3> centres;
  centres.reserve(avatar.triangles.size());
  for (const glm::uvec3& corner : avatar.triangles) {
    const glm::dvec3 sum =
        glm::dvec3(vertices[corner.x]) + glm::dvec3(vertices[corner.y]) + glm::dvec3(vertices[corner.z]);
    centres.emplace_back(finite_or_zero(sum.x), finite_or_zero(sum.y), finite_or_zero(sum.z));
  }
  return centres;
}

/// Puts triangles that are close to each other into the same meshlet. It halves the list along the longest side. The
/// first half gets as many whole meshlets as the largest power of two that leaves a second half. So each node of the
/// tree is one part of the bisection.
void bisect(std::span<std::uint32_t> triangles, const std::vector<glm::dvec3>& centres) {
  if (triangles.size() <= kMeshletTriangles) {
    std::ranges::sort(triangles);
    return;
  }
  glm::dvec3 low = centres[triangles.front()];
  glm::dvec3 high = low;
  for (const std::uint32_t triangle : triangles) {
    low = glm::min(low, centres[triangle]);
    high = glm::max(high, centres[triangle]);
  }
  const glm::dvec3 extent = high - low;
  int axis = 0;
  if (extent.y > extent[axis]) axis = 1;
  if (extent.z > extent[axis]) axis = 2;
  const std::size_t meshlets = (triangles.size() + kMeshletTriangles - 1) / kMeshletTriangles;
  const std::size_t middle = std::bit_ceil(meshlets) / 2 * kMeshletTriangles;
  std::ranges::nth_element(triangles, triangles.begin() + static_cast<std::ptrdiff_t>(middle),
                           [&](std::uint32_t a, std::uint32_t b) {
                             const double place_a = centres[a][axis];
                             const double place_b = centres[b][axis];
                             return place_a < place_b || (place_a == place_b && a < b);
                           });
  bisect(triangles.first(middle), centres);
  bisect(triangles.subspan(middle), centres);
}

/// Returns the smallest box in fp32 that surely contains everything between `low` and `high`.
RestBox rest_box(std::uint32_t entry, const glm::vec3& low, const glm::vec3& high) {
  RestBox box = {glm::vec3(0), entry, glm::vec3(0), 0};
  for (int axis = 0; axis < 3; ++axis) {
    const double l = low[axis];
    const double h = high[axis];
    const auto centre = static_cast<float>(0.5 * (l + h));
    const double half = std::max(h - static_cast<double>(centre), static_cast<double>(centre) - l);
    box.centre[axis] = centre;
    box.half_extent[axis] =
        half > 0 ? std::nextafter(static_cast<float>(half), std::numeric_limits<float>::infinity()) : 0.0F;
  }
  return box;
}

}  // namespace

Meshlets::Meshlets(const Avatar& avatar) : triangles_(avatar.triangles.size()) {
  std::iota(triangles_.begin(), triangles_.end(), 0U);
  if (triangles_.empty()) return;
  bisect(triangles_, rest_centres(avatar));
  for (std::size_t triangles_a_node = kMeshletTriangles;; triangles_a_node *= kMeshletFanout) {
    levels_.push_back(box_level(avatar, triangles_a_node));
    if (triangles_a_node >= triangles_.size()) break;
  }
}

Meshlets::Level Meshlets::box_level(const Avatar& avatar, std::size_t triangles_a_node) const {
  struct Bounds {
    glm::vec3 low;
    glm::vec3 high;
    std::size_t node;  ///< number of the node that the bounds belong to, plus 1
  };
  std::vector<Bounds> of_entry(avatar.palette.size(), {{}, {}, 0});
  std::vector<std::uint32_t> entries;
  Level level;
  for (std::size_t first = 0; first < triangles_.size(); first += triangles_a_node) {
    const std::size_t node = level.first_box.size();
    const std::size_t count = std::min(triangles_a_node, triangles_.size() - first);
    entries.clear();
    for (const std::uint32_t triangle : std::span(triangles_).subspan(first, count)) {
      const glm::uvec3& corner = avatar.triangles[triangle];
      for (const std::uint32_t vertex : {corner.x, corner.y, corner.z}) {
        const glm::vec3& position = avatar.position_bind[vertex];
        const Influences& influences = avatar.influences[vertex];
        for (std::size_t k = 0; k < avatar.influence_count; ++k) {
          if (influences.weight[k] == 0) continue;
          Bounds& bounds = of_entry[influences.palette[k]];
          if (bounds.node != node) {
            bounds = {position, position, node};
            entries.push_back(influences.palette[k]);
          }
          bounds.low = glm::min(bounds.low, position);
          bounds.high = glm::max(bounds.high, position);
        }
      }
    }
    if (entries.size() <= kMostBoxes || count == triangles_.size()) {
      std::ranges::sort(entries);
      for (const std::uint32_t entry : entries)
        level.boxes.push_back(rest_box(entry, of_entry[entry].low, of_entry[entry].high));
    }
    level.first_box.push_back(level.boxes.size());
  }
  return level;
}

}  // namespace vestige
