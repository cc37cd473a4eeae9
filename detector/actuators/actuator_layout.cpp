#include "detector/actuators/actuator_layout.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>
#include <set>
#include <utility>

#include "detector/actuators/texture_stretch.hpp"
#include "detector/actuators/uv_texels.hpp"
#include "detector/nearest_in_triangle.hpp"
#include "traces/scene/pose.hpp"
#include "traces/scene/reference_skinning.hpp"

namespace vestige {

namespace {

constexpr std::uint32_t kMostTexels = 2048;  // along a side; a finer map is sampled
constexpr std::size_t kLane = 8;             // actuators are padded to whole lanes
constexpr float kBeyond_m = 1e9F;            // represents an infinite distance, where infinite - infinite would be NaN
constexpr double kFar_m = 0.050;             // skin farther apart than this is not one place
/// The search for neighbours uses a grid of points in each triangle. The grid is this much finer than the actuators'
/// spacing.
constexpr double kPointsASpacing = 8;
constexpr int kMostPoints = 32;

std::optional<SkinPoint> nearest_on_skin(const SurfaceDistance& surface, const glm::dvec3& p) {
  std::optional<SkinPoint> best;
  double best_m = kUnreached_m;
  for (std::uint32_t number = 0; number < surface.triangles().size(); ++number) {
    const glm::uvec3& corner = surface.triangles()[number];
    const SkinPoint point = {number,
                             nearest_in_triangle(p, {surface.position_m()[corner.x], surface.position_m()[corner.y],
                                                     surface.position_m()[corner.z]})};
    const double away_m = glm::distance(p, surface.position_of(point));
    if (!(away_m < best_m)) continue;
    best = point;
    best_m = away_m;
  }
  return best;
}

double area_of(const SurfaceDistance& surface, std::uint32_t triangle) {
  const glm::uvec3& corner = surface.triangles()[triangle];
  const glm::dvec3& a = surface.position_m()[corner.x];
  const double area =
      0.5 * glm::length(glm::cross(surface.position_m()[corner.y] - a, surface.position_m()[corner.z] - a));
  return std::isfinite(area) ? area : 0;
}

struct Size {
  std::uint32_t width;
  std::uint32_t height;
};

Size sampled_size(const ActuatorMap& map) {
  return {std::min(map.width, kMostTexels), std::min(map.height, kMostTexels)};
}

/// A piece of skin as large as a texel.
struct Piece {
  SkinPoint point;         // its middle
  std::uint16_t actuator;  // the map's number
  double area_m2;
  std::size_t
      texel;  // or kNoTexel for a whole triangle: between the texels' centres, too large, or with its own actuator
};
constexpr std::size_t kNoTexel = ~std::size_t{0};

/// Visits the skin in pieces; each piece is one texel's share of a triangle, or a whole triangle.
template <typename Take>
void for_pieces_of_skin(const Avatar& avatar, const ActuatorMap& map, const SurfaceDistance& surface, Take&& take) {
  const Size size = sampled_size(map);
  const std::uint32_t width = size.width;
  const std::uint32_t height = size.height;
  const glm::dvec2 scale(width, height);
  for (std::uint32_t number = 0; number < avatar.triangles.size(); ++number) {
    const double area_m2 = area_of(surface, number);
    if (!(area_m2 > 0)) continue;
    if (map.triangle_count != 0) {
      take(Piece{{number, glm::dvec3(1.0 / 3)}, map.at(number, {}), area_m2, kNoTexel});
      continue;
    }
    const glm::uvec3& triangle = avatar.triangles[number];
    const glm::dvec2 a(avatar.texture_coordinate[triangle.x]);
    const glm::dvec2 b(avatar.texture_coordinate[triangle.y]);
    const glm::dvec2 c(avatar.texture_coordinate[triangle.z]);
    if (!std::isfinite(a.x + a.y + b.x + b.y + c.x + c.y)) continue;
    const std::array<glm::dvec2, 3> corners = {a * scale, b * scale, c * scale};
    std::size_t texels = 0;
    // A triangle that covers the texture more than once would visit each texel as often.
    if (fits_texture(corners, scale))
      for_texels_of(corners, width, height,
                    [&](std::uint32_t, std::uint32_t, std::uint32_t count) { texels += count; });
    if (texels == 0) {
      take(Piece{{number, glm::dvec3(1.0 / 3)}, map.at((a + b + c) / 3.0), area_m2, kNoTexel});
      continue;
    }
    const glm::dvec2 ab = corners[1] - corners[0];
    const glm::dvec2 ac = corners[2] - corners[0];
    const double doubled = ab.x * ac.y - ab.y * ac.x;
    for_texels_of(corners, width, height, [&](std::uint32_t row, std::uint32_t column, std::uint32_t count) {
      for (std::uint32_t i = 0; i < count; ++i) {
        glm::dvec2 at(column + i, row);
        if (at.x >= width) at.x -= width;
        at += 0.5;
        // The texel's position next to the triangle, whole turns away.
        const glm::dvec2 middle = (corners[0] + corners[1] + corners[2]) / 3.0;
        const glm::dvec2 turned = at + scale * glm::round((middle - at) / scale);
        const glm::dvec2 from = turned - corners[0];
        const double v = std::clamp((from.x * ac.y - from.y * ac.x) / doubled, 0.0, 1.0);
        const double w = std::clamp((ab.x * from.y - ab.y * from.x) / doubled, 0.0, 1.0 - v);
        const std::size_t texel = std::size_t{row} * width + static_cast<std::size_t>(at.x);
        take(Piece{
            {number, glm::dvec3(1 - v - w, v, w)}, map.at(at / scale), area_m2 / static_cast<double>(texels), texel});
      }
    });
  }
}

/// Finds skin that shares texels with other skin far away.
class SharedTexels {
 public:
  SharedTexels(const SurfaceDistance& surface, const ActuatorMap& map) : surface_(surface) {
    const auto [width, height] = sampled_size(map);
    first_.resize(std::size_t{width} * height);
  }

  void add(const Piece& piece) {
    if (piece.texel == kNoTexel) return;
    First& first = first_[piece.texel];
    if (first.triangle == kNoTriangle) {
      first = {piece.point.triangle, static_cast<float>(piece.area_m2), false};
      return;
    }
    if (!is_far(surface_.position_of(piece.point), first.triangle)) return;
    area_m2_ += piece.area_m2;
    if (!first.is_shared) area_m2_ += static_cast<double>(first.area_m2);
    first.is_shared = true;
  }

  double area_m2() const { return area_m2_; }

 private:
  struct First {
    std::uint32_t triangle = kNoTriangle;
    float area_m2 = 0;
    bool is_shared = false;
  };

  bool is_far(const glm::dvec3& from, std::uint32_t triangle) const {
    const glm::uvec3& corner = surface_.triangles()[triangle];
    const std::array<glm::dvec3, 3> corners = {surface_.position_m()[corner.x], surface_.position_m()[corner.y],
                                               surface_.position_m()[corner.z]};
    const glm::dvec3 weight = nearest_in_triangle(from, {corners[0], corners[1], corners[2]});
    return glm::distance(from, weight.x * corners[0] + weight.y * corners[1] + weight.z * corners[2]) > kFar_m;
  }

  const SurfaceDistance& surface_;
  std::vector<First> first_;
  double area_m2_ = 0;
};

}  // namespace

ActuatorLayout::ActuatorLayout(const Avatar& avatar, ActuatorMap map)
    : map_(std::move(map)),
      facing_(avatar.facing.axis),
      surface_(skin_at_rest(avatar), avatar.triangles, SurfaceDistance::Gaps::kBridged) {
  for (std::uint32_t i = 0; i < avatar.triangles.size(); ++i) skin_area_m2_ += area_of(surface_, i);
  place_actuators(avatar);
  posed_places_ = PosedPlaces(avatar, place_);
  measure_distances();
  find_neighbours();
}

double ActuatorLayout::mapped_area_m2() const {
  return std::accumulate(area_m2_.begin(), area_m2_.end(), 0.0);
}

void ActuatorLayout::place_actuators(const Avatar& avatar) {
  const std::size_t n = actuator_count();
  area_m2_.assign(n, 0);
  place_.assign(n, std::nullopt);
  position_m_.assign(n, glm::dvec3(0));
  std::vector<glm::dvec3> middle(n, glm::dvec3(0));
  SharedTexels shared(surface_, map_);
  for_pieces_of_skin(avatar, map_, surface_, [&](const Piece& piece) {
    if (piece.actuator == 0) return;
    area_m2_[piece.actuator - 1U] += piece.area_m2;
    middle[piece.actuator - 1U] += piece.area_m2 * surface_.position_of(piece.point);
    shared.add(piece);
  });
  if (mapped_area_m2() > 0) ambiguous_share_ = shared.area_m2() / mapped_area_m2();
  for (std::size_t i = 0; i < n; ++i) {
    if (i < map_.position_m.size() && map_.position_m[i]) place_[i] = nearest_on_skin(surface_, *map_.position_m[i]);
    if (area_m2_[i] > 0) middle[i] /= area_m2_[i];
  }
  std::vector<double> away_m(n, kUnreached_m);
  std::vector<bool> is_given(n);
  for (std::size_t i = 0; i < n; ++i) is_given[i] = place_[i].has_value();
  if (!std::ranges::all_of(is_given, std::identity()))
    for_pieces_of_skin(avatar, map_, surface_, [&](const Piece& piece) {
      if (piece.actuator == 0 || is_given[piece.actuator - 1U]) return;
      const std::size_t i = piece.actuator - 1U;
      const double piece_m = glm::distance(surface_.position_of(piece.point), middle[i]);
      if (!(piece_m < away_m[i])) return;
      away_m[i] = piece_m;
      place_[i] = piece.point;
    });
  place_specks(avatar);
  for (std::size_t i = 0; i < n; ++i)
    if (place_[i]) position_m_[i] = surface_.position_of(*place_[i]);
}

/// Places actuators whose regions are touched although no centre of their texels lies on skin. They have no piece of
/// skin.
void ActuatorLayout::place_specks(const Avatar& avatar) {
  constexpr int kSteps = 8;
  if (map_.triangle_count != 0) return;
  if (std::ranges::all_of(place_, [](const auto& place) { return place.has_value(); })) return;
  for (std::uint32_t number = 0; number < avatar.triangles.size(); ++number) {
    if (!(area_of(surface_, number) > 0)) continue;
    const glm::uvec3& triangle = avatar.triangles[number];
    for (int i = 0; i <= kSteps; ++i) {
      for (int j = 0; i + j <= kSteps; ++j) {
        const glm::dvec3 weight = glm::dvec3(kSteps - i - j, i, j) / static_cast<double>(kSteps);
        const glm::dvec2 at = weight.x * glm::dvec2(avatar.texture_coordinate[triangle.x]) +
                              weight.y * glm::dvec2(avatar.texture_coordinate[triangle.y]) +
                              weight.z * glm::dvec2(avatar.texture_coordinate[triangle.z]);
        const std::uint16_t actuator = std::isfinite(at.x + at.y) ? map_.at(at) : std::uint16_t{0};
        if (actuator != 0 && !place_[actuator - 1U]) place_[actuator - 1U] = SkinPoint{number, weight};
      }
    }
  }
}

void ActuatorLayout::measure_distances() {
  const std::size_t n = actuator_count();
  const std::size_t vertices = surface_.position_m().size();
  stride_ = (n + kLane - 1) / kLane * kLane;
  for (int k = 0; k < 3; ++k) {
    axes_[static_cast<std::size_t>(k)].assign(stride_, 0);
    for (std::size_t i = 0; i < n; ++i) axes_[static_cast<std::size_t>(k)][i] = static_cast<float>(position_m_[i][k]);
  }
  detour_.assign(vertices * stride_, kBeyond_m);
  between_m_.assign(n * n, kUnreached_m);
  for (std::size_t i = 0; i < n; ++i) {
    if (!place_[i]) continue;
    const std::vector<double> distance_m = surface_.from(*place_[i]);
    for (std::size_t vertex = 0; vertex < vertices; ++vertex)
      if (distance_m[vertex] < kUnreached_m)
        detour_[vertex * stride_ + i] =
            static_cast<float>(distance_m[vertex] - glm::distance(surface_.position_m()[vertex], position_m_[i]));
  }
  LocatedContact located;
  for (std::size_t a = 0; a < n; ++a) {
    if (!place_[a]) continue;
    locate(*place_[a], located);
    for (std::size_t b = 0; b < n; ++b)
      if (place_[b]) between_m_[a * n + b] = a == b ? 0 : static_cast<double>(located.distance_[b]);
  }
  // Each distance was measured from both ends.
  std::vector<double> nearest_m;
  for (std::size_t a = 0; a < n; ++a) {
    double least_m = kUnreached_m;
    for (std::size_t b = 0; b < n; ++b) {
      if (a == b) continue;
      if (a < b) between_m_[a * n + b] = between_m_[b * n + a] = 0.5 * (between_m_[a * n + b] + between_m_[b * n + a]);
      least_m = std::min(least_m, between_m_[a * n + b]);
    }
    if (least_m < kUnreached_m) nearest_m.push_back(least_m);
  }
  if (nearest_m.empty()) return;
  std::ranges::sort(nearest_m);
  spacing_m_ = 0.5 * (nearest_m[(nearest_m.size() - 1) / 2] + nearest_m[nearest_m.size() / 2]);
}

void ActuatorLayout::find_neighbours() {
  const std::size_t n = actuator_count();
  std::set<std::array<std::uint16_t, 3>> triples;
  std::set<std::pair<std::uint16_t, std::uint16_t>> pairs;
  LocatedContact located;
  std::vector<std::uint16_t> nearest;
  const auto note_pair = [&](std::uint16_t a, std::uint16_t b) {
    if (a == b) return;
    pairs.emplace(a, b);
    pairs.emplace(b, a);
  };
  const auto note = [&](std::uint16_t a, std::uint16_t b, std::uint16_t c) {
    note_pair(a, b);
    note_pair(b, c);
    note_pair(c, a);
    if (a == b || b == c || c == a) return;
    std::array<std::uint16_t, 3> triple = {a, b, c};
    std::ranges::sort(triple);
    triples.insert(triple);
  };
  const double step_m = spacing_m_ / kPointsASpacing;
  for (std::uint32_t number = 0; step_m < kUnreached_m && number < surface_.triangles().size(); ++number) {
    if (!(area_of(surface_, number) > 0)) continue;
    const glm::uvec3& corner = surface_.triangles()[number];
    const double side_m = std::max({glm::distance(surface_.position_m()[corner.x], surface_.position_m()[corner.y]),
                                    glm::distance(surface_.position_m()[corner.y], surface_.position_m()[corner.z]),
                                    glm::distance(surface_.position_m()[corner.z], surface_.position_m()[corner.x])});
    const int steps = static_cast<int>(std::clamp(std::ceil(side_m / step_m), 1.0, double{kMostPoints}));
    // Row j has steps + 1 - j points.
    nearest.clear();
    for (int j = 0; j <= steps; ++j) {
      for (int i = 0; i + j <= steps; ++i) {
        const glm::dvec2 uv = glm::dvec2(i, j) / static_cast<double>(steps);
        locate(SkinPoint{number, glm::dvec3(1 - uv.x - uv.y, uv.x, uv.y)}, located);
        const auto least = std::ranges::min_element(located.distance_m());
        nearest.push_back(static_cast<std::uint16_t>(least - located.distance_m().begin()));
      }
    }
    std::size_t row = 0;
    for (int j = 0; j < steps; ++j) {
      const auto length = static_cast<std::size_t>(steps + 1 - j);
      for (std::size_t i = 0; i + 1 < length; ++i) {
        note(nearest[row + i], nearest[row + i + 1], nearest[row + length + i]);
        if (i + 2 < length) note(nearest[row + i + 1], nearest[row + length + i + 1], nearest[row + length + i]);
      }
      row += length;
    }
  }
  neighbours_.assign(triples.begin(), triples.end());
  for (std::size_t actuator = 0; actuator < n; ++actuator) {
    first_neighbours_.push_back(static_cast<std::uint32_t>(neighbour_list_.size()));
    for (std::uint32_t k = 0; k < neighbours_.size(); ++k)
      if (std::ranges::find(neighbours_[k], actuator) != neighbours_[k].end()) neighbour_list_.push_back(k);
    first_beside_.push_back(static_cast<std::uint32_t>(beside_list_.size()));
    for (const auto& [a, b] : pairs)
      if (a == actuator) beside_list_.push_back(b);
  }
  first_neighbours_.push_back(static_cast<std::uint32_t>(neighbour_list_.size()));
  first_beside_.push_back(static_cast<std::uint32_t>(beside_list_.size()));
}

std::span<const std::uint32_t> ActuatorLayout::neighbours_of(std::size_t actuator) const {
  return {neighbour_list_.begin() + first_neighbours_[actuator],
          neighbour_list_.begin() + first_neighbours_[actuator + 1]};
}

std::span<const std::uint16_t> ActuatorLayout::beside(std::size_t actuator) const {
  return {beside_list_.begin() + first_beside_[actuator], beside_list_.begin() + first_beside_[actuator + 1]};
}

void ActuatorLayout::locate(const Contact& contact, LocatedContact& located) const {
  const glm::dvec2& uv = contact.barycentric;
  locate(SkinPoint{contact.triangle, glm::dvec3(1 - uv.x - uv.y, uv.x, uv.y)}, located);
  located.actuator = map_.at(contact.triangle, contact.texture_coordinate);
  located.speed_m_per_s = contact.speed_m_per_s;
  located.depth_m = contact.depth_m;
}

void ActuatorLayout::locate(const SkinPoint& point, LocatedContact& located) const {
  const glm::uvec3& corner = surface_.triangles()[point.triangle];
  const glm::dvec3& a = surface_.position_m()[corner.x];
  const glm::dvec3 ab = surface_.position_m()[corner.y] - a;
  const glm::dvec3 ac = surface_.position_m()[corner.z] - a;
  located.position_m = a + point.weight.y * ab + point.weight.z * ac;
  for (std::size_t i = 0; i < 3; ++i) located.detour_[i] = detour_.data() + corner[static_cast<int>(i)] * stride_;

  // The axes of the triangle's plane, and the gradients of the corners' weights along them. A triangle without area has
  // none.
  located.axis_ = {glm::dvec3(0), glm::dvec3(0)};
  located.gradient_ = {glm::dvec2(0), glm::dvec2(0), glm::dvec2(0)};
  const double length = glm::length(ab);
  if (length > 0) {
    located.axis_[0] = ab / length;
    const double along = glm::dot(ac, located.axis_[0]);
    const glm::dvec3 off = ac - along * located.axis_[0];
    const double height = glm::length(off);
    if (height > 0) {
      located.axis_[1] = off / height;
      located.gradient_[1] = {1 / length, -along / (length * height)};
      located.gradient_[2] = {0, 1 / height};
      located.gradient_[0] = -(located.gradient_[1] + located.gradient_[2]);
    }
  }

  located.actuator = 0;
  located.speed_m_per_s = 0;
  located.depth_m = 0;
  located.covered = {};
  located.count_ = actuator_count();
  located.distance_.resize(stride_);
  const auto x = static_cast<float>(located.position_m.x);
  const auto y = static_cast<float>(located.position_m.y);
  const auto z = static_cast<float>(located.position_m.z);
  const auto wa = static_cast<float>(point.weight.x);
  const auto wb = static_cast<float>(point.weight.y);
  const auto wc = static_cast<float>(point.weight.z);
  const float* const detour_a = located.detour_[0];
  const float* const detour_b = located.detour_[1];
  const float* const detour_c = located.detour_[2];
  const float* const ax = axes_[0].data();
  const float* const ay = axes_[1].data();
  const float* const az = axes_[2].data();
  float* const distance = located.distance_.data();
  for (std::size_t i = 0; i < stride_; ++i) {
    const float dx = x - ax[i];
    const float dy = y - ay[i];
    const float dz = z - az[i];
    distance[i] = std::sqrt(dx * dx + dy * dy + dz * dz) + (wa * detour_a[i] + wb * detour_b[i] + wc * detour_c[i]);
  }
}

glm::dvec2 ActuatorLayout::towards_m(const LocatedContact& located, std::size_t actuator) const {
  const glm::dvec3 away = located.position_m - position_m_[actuator];
  const double straight_m = glm::length(away);
  glm::dvec2 growth(0);
  if (straight_m > 0)
    growth = glm::dvec2(glm::dot(away, located.axis_[0]), glm::dot(away, located.axis_[1])) / straight_m;
  for (std::size_t i = 0; i < 3; ++i)
    growth += static_cast<double>(located.detour_[i][actuator]) * located.gradient_[i];
  const double length = glm::length(growth);
  if (!(length > 0)) return glm::dvec2(0);
  return growth * (-static_cast<double>(located.distance_[actuator]) / length);
}

double ActuatorLayout::distance_m(const SkinPoint& a, const SkinPoint& b) const {
  const std::vector<double> from_a = surface_.from(a);
  const glm::dvec3 start = surface_.position_of(a);
  const glm::uvec3& corner = surface_.triangles()[b.triangle];
  double detour_m = 0;
  for (int i = 0; i < 3; ++i)
    detour_m += b.weight[i] * (from_a[corner[i]] - glm::distance(start, surface_.position_m()[corner[i]]));
  return glm::distance(start, surface_.position_of(b)) + detour_m;
}

}  // namespace vestige
