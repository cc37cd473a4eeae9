#include "analysis/mapping/skin_pieces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "analysis/mapping/skin_patches.hpp"

namespace vestige {

namespace {

constexpr double kMostPatches = 1 << 23;

class Pieces {
 public:
  Pieces(const BodySurface& surface, const ActuatorMap& map)
      : surface_(surface), map_(map), size_(map.width, map.height) {}

  std::vector<SkinPatch> find() {
    cut();
    root_.resize(patches_.size());
    std::iota(root_.begin(), root_.end(), 0U);
    for (std::uint32_t i = 0; i < cuts_.size(); ++i) join_within(i);
    join_across();
    for (std::uint32_t i = 0; i < patches_.size(); ++i) patches_[i].piece = root_of(i);
    return std::move(patches_);
  }

 private:
  /// A triangle's side at an edge that other triangles may share.
  struct Side {
    std::uint32_t triangle;
    int edge;
    bool is_backward;
  };

  void cut() {
    const auto triangles = static_cast<std::uint32_t>(surface_.avatar().triangles.size());
    const auto patches_of = [&](std::uint32_t triangle, double step) {
      return map_.triangle_count == 0 ? patches_of_texels(surface_, triangle, size_, step)
                                      : patches_of_body(surface_, triangle, step);
    };
    const double step = affordable_step(surface_, kMostPatches, patches_of);
    for (std::uint32_t i = 0; i < triangles; ++i) cuts_.push_back(patches_of(i, step));
    for (const SkinPatches& cut : cuts_) {
      first_.push_back(patches_.size());
      const auto area_m2 = static_cast<float>(surface_.area_m2(cut.triangle) / static_cast<double>(cut.count()));
      cut.for_each([&](const SkinPoint& point) { patches_.push_back(patch_at(point, area_m2)); });
    }
  }

  SkinPatch patch_at(const SkinPoint& point, float area_m2) const {
    SkinPatch patch;
    patch.position_m = surface_.position_m(point);
    patch.area_m2 = area_m2;
    const glm::dvec2 coordinate = surface_.texture_coordinate(point);
    patch.actuator = map_.at(point.triangle, coordinate);
    if (map_.triangle_count != 0) {
      patch.texel = point.triangle;
    } else if (std::isfinite(coordinate.x) && std::isfinite(coordinate.y)) {
      const auto texel = [](double value, std::uint32_t side) {
        return std::min(static_cast<std::uint32_t>((value - std::floor(value)) * side), side - 1);
      };
      patch.texel = texel(coordinate.y, map_.height) * map_.width + texel(coordinate.x, map_.width);
    }
    return patch;
  }

  std::uint32_t root_of(std::uint32_t patch) {
    while (root_[patch] != patch) patch = root_[patch] = root_[root_[patch]];
    return patch;
  }

  void join(std::size_t a, std::size_t b) {
    if (patches_[a].actuator != patches_[b].actuator) return;
    const std::uint32_t root_a = root_of(static_cast<std::uint32_t>(a));
    const std::uint32_t root_b = root_of(static_cast<std::uint32_t>(b));
    root_[std::max(root_a, root_b)] = std::min(root_a, root_b);
  }

  void join_within(std::uint32_t triangle) {
    const SkinPatches& cut = cuts_[triangle];
    const std::size_t first = first_[triangle];
    for (std::uint32_t i = 0; i < cut.n; ++i)
      for (std::uint32_t j = 0; i + j + 1 < cut.n; ++j) {
        const std::size_t down = first + cut.upward(i, j) + 1;
        join(down - 1, down);
        join(down, first + cut.upward(i + 1, j));
        join(down, first + cut.upward(i, j + 1));
      }
  }

  /// Returns the `number`-th patch along a triangle's edge, counted in the direction that is common to all sides of the
  /// edge.
  std::size_t along(const Side& side, std::uint32_t number) const {
    const SkinPatches& cut = cuts_[side.triangle];
    const std::uint32_t k = side.is_backward ? cut.n - 1 - number : number;
    const std::size_t first = first_[side.triangle];
    if (side.edge == 0) return first + cut.upward(k, 0);
    return first + (side.edge == 1 ? cut.upward(cut.n - 1 - k, k) : cut.upward(0, cut.n - 1 - k));
  }

  void join_across() {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<Side>> edges;
    for (std::uint32_t i = 0; i < cuts_.size(); ++i) {
      const glm::uvec3 places = surface_.places(i);
      for (int edge = 0; edge < 3; ++edge) {
        const std::uint32_t from = places[edge];
        const std::uint32_t to = places[(edge + 1) % 3];
        if (from != to) edges[std::minmax(from, to)].push_back({i, edge, from > to});
      }
    }
    for (const auto& [places, sides] : edges)
      for (std::size_t other = 1; other < sides.size(); ++other) join_sides(sides[0], sides[other]);
  }

  void join_sides(const Side& a, const Side& b) {
    const std::uint64_t a_count = cuts_[a.triangle].n;
    const std::uint64_t b_count = cuts_[b.triangle].n;
    for (std::uint64_t i = 0; i < a_count; ++i)
      for (std::uint64_t j = i * b_count / a_count; j * a_count < (i + 1) * b_count; ++j)
        join(along(a, static_cast<std::uint32_t>(i)), along(b, static_cast<std::uint32_t>(j)));
  }

  const BodySurface& surface_;
  const ActuatorMap& map_;
  glm::dvec2 size_;
  std::vector<SkinPatches> cuts_;   ///< of every triangle
  std::vector<std::size_t> first_;  ///< of every triangle's patches
  std::vector<SkinPatch> patches_;
  std::vector<std::uint32_t> root_;
};

}  // namespace

std::vector<SkinPatch> skin_pieces(const BodySurface& surface, const ActuatorMap& map) {
  return Pieces(surface, map).find();
}

}  // namespace vestige
