#include "detector/depth/skin_distance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

#include "detector/broad/skin_motion.hpp"
#include "detector/nearest_in_triangle.hpp"

namespace vestige {

namespace {

/// A triangle of less height than this, relative to its largest coordinate, has no area: fp32 gives its plane any
/// direction.
constexpr double kFlat = 0x1p-20;

/// Where many vertices share one place, only so many are looked at.
constexpr std::size_t kMostAtOnePlace = 10000;
constexpr std::size_t kMostEdges = 64;

double squared_length(const glm::dvec3& from, const glm::dvec3& to) {
  return glm::dot(to - from, to - from);
}

double squared_distance_to_segment(const glm::dvec3& point, const glm::dvec3& from, const glm::dvec3& to) {
  const Corners segment = {from, to, to};
  return squared_length(point, weighed(nearest_on_edges(point, segment), segment));
}

}  // namespace

SkinDistance::SkinDistance(const Avatar& avatar)
    : avatar_(avatar),
      neighbours_(avatar),
      meshlets_(avatar),
      bounds_(avatar, meshlets_),
      skin_(avatar, meshlets_),
      boxes_(meshlets_.size()),
      slot_(meshlets_.size(), 0),
      visited_(avatar.position_bind.size(), 0) {}

void SkinDistance::begin(const DetectorFrame& frame) {
  frame_ = &frame;
  bounds_.begin(frame, Method::kStatic);
  bounds_.boxes(0, 0, boxes_);
  for (const std::size_t meshlet : looked_into_) slot_[meshlet] = 0;
  looked_into_.clear();
}

SkinDistance::PlaneSide SkinDistance::side_of(const glm::dvec3& point, const Corners& triangle) {
  const auto& [a, b, c] = triangle;
  const glm::dvec3 normal = glm::cross(b - a, c - a);
  const double area = glm::dot(normal, normal);
  const glm::dvec3 sizes = glm::max(glm::max(glm::abs(a), glm::abs(b)), glm::abs(c));
  const double flat_m = kFlat * std::max({sizes.x, sizes.y, sizes.z});
  if (!(area > flat_m * flat_m * std::max({squared_length(a, b), squared_length(b, c), squared_length(c, a)})))
    return {};
  const double height = glm::dot(point - a, normal);
  return {true, height, height * height / area};
}

double SkinDistance::signed_m(const glm::dvec3& point) {
  const Nearest nearest = nearest_to(point);
  const double distance_m = std::sqrt(nearest.squared_m2);
  return is_behind(point, nearest) ? -distance_m : distance_m;
}

SkinDistance::Nearest SkinDistance::nearest_to(const glm::dvec3& point) {
  const auto bound_of = [&](const SkinBox& box) {
    return squared_distance_to_box(point, glm::dvec3(box.low), glm::dvec3(box.high));
  };
  const auto first = static_cast<std::size_t>(std::ranges::min_element(boxes_, {}, bound_of) - boxes_.begin());
  Nearest best = {std::numeric_limits<double>::infinity(), 0, glm::dvec3(0)};
  look_into(first, point, best);
  for (std::size_t i = 0; i < boxes_.size(); ++i)
    if (i != first && bound_of(boxes_[i]) <= best.squared_m2) look_into(i, point, best);
  return best;
}

void SkinDistance::look_into(std::size_t meshlet, const glm::dvec3& point, Nearest& best) {
  const MeshletCorners& corners = skinned(meshlet);
  const std::span<const std::uint32_t> triangles = meshlets_.triangles(meshlet);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const Corners triangle = corners.corners(i);
    glm::dvec3 weights = nearest_in_triangle(point, triangle);
    if (!are_shares(weights)) weights = nearest_on_edges(point, triangle);  // of a triangle without area
    const glm::dvec3 away = weighed(weights, triangle) - point;
    const double squared_m2 = glm::dot(away, away);
    if (squared_m2 < best.squared_m2 || (squared_m2 == best.squared_m2 && triangles[i] < best.triangle))
      best = {squared_m2, triangles[i], weights};
  }
}

const MeshletCorners& SkinDistance::skinned(std::size_t meshlet) {
  if (slot_[meshlet] == 0) {
    looked_into_.push_back(meshlet);
    slot_[meshlet] = static_cast<std::uint32_t>(looked_into_.size());
    if (skinned_.size() < looked_into_.size()) skinned_.emplace_back();
    skin_.skin(meshlet, frame_->palette, skinned_[slot_[meshlet] - 1]);
  }
  return skinned_[slot_[meshlet] - 1];
}

Corners SkinDistance::corners_of(std::uint32_t triangle) const {
  return skin_corners(avatar_, *frame_, Method::kStatic, triangle).now;
}

bool SkinDistance::is_behind(const glm::dvec3& point, const Nearest& nearest) {
  const Corners triangle = corners_of(nearest.triangle);
  const std::array places = {triangle.a, triangle.b, triangle.c};
  const Numbers numbers = numbers_of(nearest.triangle);
  std::array<std::size_t, 3> used = {};
  std::size_t count = 0;
  for (std::size_t i = 0; i < 3; ++i)
    if (nearest.weights[static_cast<int>(i)] > 0) used[count++] = i;
  if (count == 3) {
    const PlaneSide side = side_of(point, triangle);
    if (side.has_plane) return side.height < 0;
    // The triangle is but a line: its longest edge.
    std::size_t from = 0;
    for (std::size_t i = 1; i < 3; ++i)
      if (squared_length(places[i], places[(i + 1) % 3]) > squared_length(places[from], places[(from + 1) % 3]))
        from = i;
    used = {from, (from + 1) % 3};
    count = 2;
  }
  if (count == 2 && places[used[0]] != places[used[1]])
    return is_behind_edge(point, numbers[used[0]], numbers[used[1]]);
  return is_behind_corner(point, numbers[used[0]]);
}

SkinDistance::Numbers SkinDistance::numbers_of(std::uint32_t triangle) const {
  const glm::uvec3& corner = avatar_.triangles[triangle];
  return {neighbours_.welded(corner.x), neighbours_.welded(corner.y), neighbours_.welded(corner.z)};
}

bool SkinDistance::is_behind_edge(const glm::dvec3& point, std::uint32_t from, std::uint32_t to) {
  PlaneSide farthest;
  bool is_closed = true;
  crossed_.clear();
  edges_.assign(1, {from, to});
  for (std::size_t i = 0; i < std::min(edges_.size(), kMostEdges); ++i)
    is_closed = look_at_edge(point, edges_[i][0], edges_[i][1], farthest) && is_closed;
  return is_closed && farthest.height < 0;
}

/// Takes the farthest plane among the triangles on an edge. Of those without area, it adds the edge beyond to `edges_`.
/// Returns whether the edge runs forth in one triangle and back in another, however many there are.
bool SkinDistance::look_at_edge(const glm::dvec3& point, std::uint32_t from, std::uint32_t to, PlaneSide& farthest) {
  bool forth = false;
  bool back = false;
  for (const std::uint32_t triangle : neighbours_.triangles_around(from)) {
    const Numbers numbers = numbers_of(triangle);
    const auto here = static_cast<std::size_t>(std::ranges::find(numbers, from) - numbers.begin());
    const std::uint32_t next = numbers[(here + 1) % 3];
    const std::uint32_t last = numbers[(here + 2) % 3];
    if ((next != to && last != to) || next == last || next == from || last == from) continue;
    (next == to ? forth : back) = true;
    const Corners corners = corners_of(triangle);
    const PlaneSide side = side_of(point, corners);
    if (side.squared_m2 > farthest.squared_m2) farthest = side;
    if (side.has_plane || std::ranges::find(crossed_, triangle) != crossed_.end()) continue;
    crossed_.push_back(triangle);
    const std::array places = {corners.a, corners.b, corners.c};
    const std::size_t third = (here + (next == to ? 2 : 1)) % 3;
    const glm::dvec3& middle = places[third];
    const glm::dvec3& end = places[(here + (next == to ? 1 : 2)) % 3];
    const bool is_near_from =
        middle == end || (middle != places[here] && squared_distance_to_segment(point, places[here], middle) <=
                                                        squared_distance_to_segment(point, middle, end));
    edges_.push_back(is_near_from ? Edge{from, numbers[third]} : Edge{numbers[third], to});
  }
  return forth && back;
}

bool SkinDistance::is_behind_corner(const glm::dvec3& point, std::uint32_t corner) {
  // Vertices at the same place of the posed skin count as one.
  together_.assign(1, corner);
  ++visit_;
  visited_[corner] = visit_;
  double steepest = -std::numeric_limits<double>::infinity();
  Edge towards = {corner, corner};
  for (std::size_t k = 0; k < std::min(together_.size(), kMostAtOnePlace); ++k) {
    const std::uint32_t vertex = together_[k];
    for (const std::uint32_t triangle : neighbours_.triangles_around(vertex)) {
      const Numbers numbers = numbers_of(triangle);
      const Corners place = corners_of(triangle);
      const std::array places = {place.a, place.b, place.c};
      const auto here = static_cast<std::size_t>(std::ranges::find(numbers, vertex) - numbers.begin());
      for (std::size_t i = 1; i < 3; ++i) {
        const std::size_t other = (here + i) % 3;
        const glm::dvec3 edge = places[other] - places[here];
        const double length = glm::dot(edge, edge);
        if (!(length > 0)) {
          if (std::exchange(visited_[numbers[other]], visit_) != visit_) together_.push_back(numbers[other]);
          continue;
        }
        const double along = glm::dot(point - places[here], edge);
        const double steepness = along * std::abs(along) / length;  // as the cosine, squared with its sign
        if (steepness <= steepest) continue;
        steepest = steepness;
        towards = {vertex, numbers[other]};
      }
    }
  }
  return towards[0] != towards[1] && is_behind_edge(point, towards[0], towards[1]);
}

}  // namespace vestige
