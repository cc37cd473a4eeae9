#include "detector/actuators/surface_distance.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <numeric>
#include <queue>
#include <tuple>
#include <utility>

#include "traces/scene/box.hpp"
#include "traces/scene/welding.hpp"

namespace vestige {

namespace {

constexpr double kNear = 0.01;  // share of the box's longest side: parts this close lie on each other
/// A vertex is marched on from at most this often. Otherwise rounding, or a mesh made for it, could keep the front
/// moving forever.
constexpr int kMostVisits = 32;
/// A distance that is shorter by less than this share does not restart the march.
constexpr double kGain = 1e-12;

bool is_finite(const glm::dvec3& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

/// Returns the distance at C from the distances at A and B, as from a point in the plane of the triangle, on the other
/// side of A B (Novotni & Klein 2002, §3.1). Returns +inf if there is no such point, or if its straight line to C does
/// not cross A B.
double unfold(double at_a_m, double at_b_m, double ab_m, double ac_m, double bc_m) {
  if (!(ab_m > 0)) return kUnreached_m;
  const double cx = (ac_m * ac_m - bc_m * bc_m + ab_m * ab_m) / (2 * ab_m);
  const double cy_squared = ac_m * ac_m - cx * cx;
  const double sx = (at_a_m * at_a_m - at_b_m * at_b_m + ab_m * ab_m) / (2 * ab_m);
  const double sy_squared = at_a_m * at_a_m - sx * sx;
  if (!(cy_squared > 0) || !(sy_squared >= 0)) return kUnreached_m;
  const double cy = std::sqrt(cy_squared);
  const double sy = std::sqrt(sy_squared);
  const double crossing = sx + (cx - sx) * (sy / (sy + cy));
  if (!(crossing >= 0 && crossing <= ab_m)) return kUnreached_m;
  return std::sqrt((cx - sx) * (cx - sx) + (cy + sy) * (cy + sy));
}

std::uint32_t root_of(std::vector<std::uint32_t>& parent, std::uint32_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

/// Unites two groups; the smaller number represents both.
void unite(std::vector<std::uint32_t>& parent, std::uint32_t a, std::uint32_t b) {
  a = root_of(parent, a);
  b = root_of(parent, b);
  parent[std::max(a, b)] = std::min(a, b);
}

}  // namespace

SurfaceDistance::SurfaceDistance(std::vector<glm::dvec3> position_m, std::span<const glm::uvec3> triangles, Gaps gaps)
    : position_m_(std::move(position_m)), triangles_(triangles.begin(), triangles.end()) {
  // A vertex that is not finite represents itself.
  weld_ = weld(position_m_.size(), [&](std::uint32_t i) {
    const glm::dvec3& p = position_m_[i];
    return is_finite(p) ? std::tuple(p.x, p.y, p.z, 0U) : std::tuple(0.0, 0.0, 0.0, i + 1);
  });
  build_fans();
  std::vector<std::uint32_t> part = find_parts();
  if (gaps == Gaps::kBridged && parts_ > 1) build_bridges(std::move(part));
}

void SurfaceDistance::build_fans() {
  std::vector<std::vector<Fan>> fans(position_m_.size());
  for (const glm::uvec3& triangle : triangles_) {
    const std::array<std::uint32_t, 3> corner = {weld_[triangle.x], weld_[triangle.y], weld_[triangle.z]};
    if (!std::ranges::all_of(corner, [&](std::uint32_t i) { return is_finite(position_m_[i]); })) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = corner[(i + 1) % 3];
      const std::uint32_t b = corner[(i + 2) % 3];
      const glm::dvec3& here = position_m_[corner[i]];
      fans[corner[i]].push_back({{a, b},
                                 {glm::distance(here, position_m_[a]), glm::distance(here, position_m_[b])},
                                 glm::distance(position_m_[a], position_m_[b])});
    }
  }
  first_fan_.assign(1, 0);
  for (const std::vector<Fan>& of_vertex : fans) {
    fans_.insert(fans_.end(), of_vertex.begin(), of_vertex.end());
    first_fan_.push_back(static_cast<std::uint32_t>(fans_.size()));
  }
}

std::vector<std::uint32_t> SurfaceDistance::find_parts() {
  std::vector<std::uint32_t> part(position_m_.size());
  std::iota(part.begin(), part.end(), 0U);
  for (std::uint32_t i = 0; i < part.size(); ++i)
    for (std::uint32_t k = first_fan_[i]; k < first_fan_[i + 1]; ++k)
      for (const std::uint32_t other : fans_[k].other) unite(part, i, other);
  for (std::uint32_t i = 0; i < part.size(); ++i) {
    part[i] = root_of(part, i);
    if (part[i] == i && first_fan_[i] != first_fan_[i + 1]) ++parts_;
  }
  return part;
}

void SurfaceDistance::build_bridges(std::vector<std::uint32_t> part) {
  bridges_.resize(position_m_.size());
  std::vector<std::uint32_t> vertices;
  std::vector<glm::dvec3> points;
  for (std::uint32_t i = 0; i < part.size(); ++i) {
    if (first_fan_[i] == first_fan_[i + 1]) continue;
    vertices.push_back(i);
    points.push_back(position_m_[i]);
  }
  const auto join = [&](std::uint32_t a, std::uint32_t b, double length_m) {
    bridges_[a].push_back({b, length_m});
    bridges_[b].push_back({a, length_m});
  };

  // Find parts that lie on each other, by cells as wide as the reach.
  const Box box = box_around(points);
  const double reach_m = kNear * box.longest_side();
  const auto cell_of = [&](const glm::dvec3& p) {
    const auto along = [&](double x) { return reach_m > 0 ? static_cast<long>(std::floor(x / reach_m)) : 0L; };
    return std::tuple(along(p.x - box.low.x), along(p.y - box.low.y), along(p.z - box.low.z));
  };
  std::map<std::tuple<long, long, long>, std::vector<std::uint32_t>> cells;
  for (const std::uint32_t i : vertices) cells[cell_of(position_m_[i])].push_back(i);
  std::vector<std::uint32_t> group = part;
  for (const std::uint32_t i : vertices) {
    const auto [x, y, z] = cell_of(position_m_[i]);
    std::uint32_t nearest = i;
    double nearest_m = reach_m;
    for (long k = 0; k < 27; ++k) {
      const auto cell = cells.find({x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1});
      if (cell == cells.end()) continue;
      for (const std::uint32_t other : cell->second) {
        if (part[other] == part[i]) continue;
        const double away_m = glm::distance(position_m_[i], position_m_[other]);
        if (away_m < nearest_m || (away_m == nearest_m && (nearest == i || other < nearest))) {
          nearest = other;
          nearest_m = away_m;
        }
      }
    }
    if (nearest == i) continue;
    join(i, nearest, nearest_m);
    unite(group, i, nearest);
  }

  // Join what is still apart, nearest first (Prim), from the group of the first vertex outwards.
  for (const std::uint32_t i : vertices) group[i] = root_of(group, i);
  std::vector<std::uint32_t> nearest(position_m_.size(), 0);
  std::vector<double> nearest_m(position_m_.size(), kUnreached_m);
  std::vector<std::uint32_t> added;
  std::vector<std::uint32_t> outside;
  for (const std::uint32_t i : vertices) (group[i] == group[vertices.front()] ? added : outside).push_back(i);
  while (!outside.empty()) {
    std::uint32_t best = outside.front();
    for (const std::uint32_t i : outside) {
      for (const std::uint32_t from : added) {
        const double away_m = glm::distance(position_m_[i], position_m_[from]);
        if (away_m < nearest_m[i]) {
          nearest_m[i] = away_m;
          nearest[i] = from;
        }
      }
      if (nearest_m[i] < nearest_m[best]) best = i;
    }
    join(best, nearest[best], nearest_m[best]);
    added.clear();
    std::vector<std::uint32_t> rest;
    for (const std::uint32_t i : outside) (group[i] == group[best] ? added : rest).push_back(i);
    outside = std::move(rest);
  }
}

glm::dvec3 SurfaceDistance::position_of(const SkinPoint& point) const {
  const glm::uvec3& corner = triangles_[point.triangle];
  return point.weight.x * position_m_[corner.x] + point.weight.y * position_m_[corner.y] +
         point.weight.z * position_m_[corner.z];
}

std::vector<double> SurfaceDistance::from(const SkinPoint& source) const {
  std::vector<double> distance_m(position_m_.size(), kUnreached_m);
  std::vector<int> visits(position_m_.size(), 0);
  const glm::dvec3 origin = position_of(source);
  using Entry = std::pair<double, std::uint32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
  const auto reach = [&](std::uint32_t vertex, double candidate_m) {
    if (!(candidate_m < distance_m[vertex])) return;
    candidate_m = std::max(candidate_m, glm::distance(origin, position_m_[vertex]));
    if (!(candidate_m < distance_m[vertex] * (1 - kGain))) return;
    distance_m[vertex] = candidate_m;
    front.emplace(candidate_m, vertex);
  };
  if (is_finite(origin)) {
    const glm::uvec3& corner = triangles_[source.triangle];
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t vertex = weld_[corner[i]];
      reach(vertex, glm::distance(origin, position_m_[vertex]));
    }
  }
  while (!front.empty()) {
    const auto [here_m, here] = front.top();
    front.pop();
    if (here_m != distance_m[here] || ++visits[here] > kMostVisits) continue;
    for (std::uint32_t k = first_fan_[here]; k < first_fan_[here + 1]; ++k) {
      const Fan& fan = fans_[k];
      for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) reach(fan.other[i], here_m + fan.side_m[i]);
      for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
        const double other_m = distance_m[fan.other[1 - i]];
        if (other_m < kUnreached_m)
          reach(fan.other[i], unfold(here_m, other_m, fan.side_m[1 - i], fan.side_m[i], fan.base_m));
      }
    }
    if (!bridges_.empty())
      for (const Bridge& bridge : bridges_[here]) reach(bridge.to, here_m + bridge.length_m);
  }
  for (std::size_t i = 0; i < distance_m.size(); ++i) distance_m[i] = distance_m[weld_[i]];
  return distance_m;
}

}  // namespace vestige
