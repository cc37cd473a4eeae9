#include "analysis/mapping/map_raster.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "detector/actuators/texture_stretch.hpp"

namespace vestige {

namespace {

using Corners2 = std::array<glm::dvec2, 3>;

struct Nearest {
  glm::dvec3 weight;
  double distance_squared = std::numeric_limits<double>::infinity();
};

/// Returns the point of a triangle that is nearest to `p`. The triangle may have no area.
Nearest nearest_in(const Corners2& corners, const glm::dvec2& p) {
  const auto cross = [](const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; };
  const glm::dvec2 ab = corners[1] - corners[0];
  const glm::dvec2 ac = corners[2] - corners[0];
  const double area = cross(ab, ac);
  if (area != 0) {
    const double u = cross(p - corners[0], ac) / area;
    const double v = cross(ab, p - corners[0]) / area;
    if (u >= 0 && v >= 0 && u + v <= 1) return {{1 - u - v, u, v}, 0};
  }
  Nearest best;
  for (int i = 0; i < 3; ++i) {
    const int next = (i + 1) % 3;
    const glm::dvec2& from = corners[static_cast<std::size_t>(i)];
    const glm::dvec2 edge = corners[static_cast<std::size_t>(next)] - from;
    const double length_squared = glm::dot(edge, edge);
    const double share = length_squared > 0 ? std::clamp(glm::dot(p - from, edge) / length_squared, 0.0, 1.0) : 0;
    const glm::dvec2 off = p - (from + share * edge);
    const double distance_squared = glm::dot(off, off);
    if (distance_squared >= best.distance_squared) continue;
    best = {glm::dvec3(0), distance_squared};
    best.weight[i] = 1 - share;
    best.weight[next] = share;
  }
  return best;
}

class Painter {
 public:
  Painter(const BodySurface& surface, const ActuatorAt& actuator_at, MapRaster& map)
      : surface_(surface),
        actuator_at_(actuator_at),
        map_(map),
        far_squared_(std::pow(kFarApart * surface.bounds().longest_side(), 2)),
        distance_squared_(map.actuator.size(), std::numeric_limits<float>::infinity()),
        owner_(map.actuator.size(), 0) {}

  void paint(std::uint32_t triangle) {
    const glm::dvec2 size(map_.side);
    const Corners2 corners = surface_.texels(triangle, size);
    if (!fits_texture(corners, size)) {
      ++map_.triangles_left_out;
      return;
    }
    for_touched_texels(corners, [&](std::int64_t column, std::int64_t row) { touch(triangle, corners, column, row); });
  }

  void pad(std::uint32_t padding);

 private:
  std::size_t index(std::int64_t column, std::int64_t row) const {
    const auto side = static_cast<std::int64_t>(map_.side);
    return static_cast<std::size_t>(((row % side) + side) % side * side + ((column % side) + side) % side);
  }

  bool is_free(std::size_t texel) const { return std::isinf(distance_squared_[texel]); }

  void touch(std::uint32_t triangle, const Corners2& corners, std::int64_t column, std::int64_t row) {
    const glm::dvec2 middle(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5);
    const Nearest nearest = nearest_in(corners, middle);
    const std::size_t texel = index(column, row);
    const auto distance_squared = static_cast<float>(nearest.distance_squared);
    if (distance_squared > distance_squared_[texel]) return;
    const SkinPoint point = {triangle, nearest.weight};
    const std::uint16_t actuator = actuator_at_(point);
    if (is_free(texel)) ++map_.texels_of_skin;
    if (distance_squared == distance_squared_[texel]) {
      if (actuator == map_.actuator[texel] || distance_squared > 0) return;
      const bool wins = map_.actuator[texel] == 0;
      if (is_far(texel, column, row, point))
        ++map_.conflicts[wins ? std::pair(actuator, map_.actuator[texel]) : std::pair(map_.actuator[texel], actuator)];
      if (!wins) return;
    }
    distance_squared_[texel] = distance_squared;
    owner_[texel] = triangle;
    map_.actuator[texel] = actuator;
  }

  /// Returns whether the skin that a texel already shows is far from `point`.
  bool is_far(std::size_t texel, std::int64_t column, std::int64_t row, const SkinPoint& point) const {
    const Corners2 corners = surface_.texels(owner_[texel], glm::dvec2(map_.side));
    // The owner may lie a whole turn of the texture away.
    const double side = map_.side;
    const glm::dvec2 middle(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5);
    const glm::dvec2 turns = glm::round((middle - corners[0]) / side);
    Nearest best;
    for (int dx = -1; dx <= 1; ++dx)
      for (int dy = -1; dy <= 1; ++dy) {
        const Nearest found = nearest_in(corners, middle - (turns + glm::dvec2(dx, dy)) * side);
        if (found.distance_squared < best.distance_squared) best = found;
      }
    const glm::dvec3 apart = surface_.position_m(point) - surface_.position_m({owner_[texel], best.weight});
    return glm::dot(apart, apart) > far_squared_;
  }

  const BodySurface& surface_;
  const ActuatorAt& actuator_at_;
  MapRaster& map_;
  double far_squared_;
  std::vector<float> distance_squared_;  ///< from each texel's middle to the skin that it shows; +inf: shows none
  std::vector<std::uint32_t> owner_;     ///< the triangle that it shows
};

void Painter::pad(std::uint32_t padding) {
  struct Step {
    std::int64_t x;
    std::int64_t y;
  };
  std::vector<Step> steps;
  const auto reach = static_cast<std::int64_t>(padding);
  for (std::int64_t y = -reach; y <= reach; ++y)
    for (std::int64_t x = -reach; x <= reach; ++x)
      if (x * x + y * y > 0 && x * x + y * y <= reach * reach) steps.push_back({x, y});
  std::ranges::stable_sort(steps, {}, [](const Step& step) { return step.x * step.x + step.y * step.y; });
  const std::vector<std::uint16_t> shown = map_.actuator;
  const auto side = static_cast<std::int64_t>(map_.side);
  const auto is_inside = [&](std::int64_t at) { return at >= reach && at < side - reach; };
  for (std::int64_t row = 0; row < side; ++row)
    for (std::int64_t column = 0; column < side; ++column) {
      const std::size_t texel = index(column, row);
      if (!is_free(texel)) continue;
      const bool wraps = !is_inside(column) || !is_inside(row);
      for (const Step& step : steps) {
        // `index` divides, which takes far longer than the rest.
        const std::size_t other = wraps ? index(column + step.x, row + step.y)
                                        : static_cast<std::size_t>((row + step.y) * side + column + step.x);
        if (is_free(other)) continue;
        map_.actuator[texel] = shown[other];
        break;
      }
    }
}

}  // namespace

MapRaster rasterise(const BodySurface& surface, const ActuatorAt& actuator_at, std::uint32_t side,
                    std::uint32_t padding, const WorkProgress& progress) {
  MapRaster map;
  map.side = side;
  map.actuator.assign(std::size_t{side} * side, 0);
  Painter painter(surface, actuator_at, map);
  for_each_triangle(surface, progress, [&](std::uint32_t triangle) { painter.paint(triangle); });
  painter.pad(padding);
  return map;
}

}  // namespace vestige
