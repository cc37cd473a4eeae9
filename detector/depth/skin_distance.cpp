#include "detector/depth/skin_distance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "detector/broad/skin_motion.hpp"
#include "detector/nearest_in_triangle.hpp"

namespace vestige {

SkinDistance::SkinDistance(const Avatar& avatar)
    : avatar_(avatar),
      neighbours_(avatar),
      meshlets_(avatar),
      bounds_(avatar, meshlets_),
      skin_(avatar, meshlets_),
      boxes_(meshlets_.size()),
      slot_(meshlets_.size(), 0) {}

void SkinDistance::begin(const DetectorFrame& frame) {
  frame_ = &frame;
  bounds_.begin(frame, Method::kStatic);
  bounds_.boxes(0, 0, boxes_);
  for (const std::size_t meshlet : looked_into_) slot_[meshlet] = 0;
  looked_into_.clear();
}

namespace {

double squared_distance_to_segment(const glm::dvec3& point, const glm::dvec3& from, const glm::dvec3& to) {
  const Corners segment = {from, to, to};
  const glm::dvec3 away = weighed(nearest_on_edges(point, segment), segment) - point;
  return glm::dot(away, away);
}

}  // namespace

SkinDistance::PlaneSide SkinDistance::side_of(const glm::dvec3& point, const Corners& triangle) {
  const glm::dvec3 normal = glm::cross(triangle.b - triangle.a, triangle.c - triangle.a);
  const double area = glm::dot(normal, normal);
  if (!(area > 0)) return {};
  const double height = glm::dot(point - triangle.a, normal);
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
  const glm::uvec3& corner = avatar_.triangles[nearest.triangle];
  const std::array places = {neighbours_.welded(corner.x), neighbours_.welded(corner.y), neighbours_.welded(corner.z)};
  std::array<std::uint32_t, 3> used = {};
  std::size_t count = 0;
  for (std::size_t i = 0; i < 3; ++i)
    if (nearest.weights[static_cast<int>(i)] > 0) used[count++] = places[i];
  if (count == 3) return side_of(point, corners_of(nearest.triangle)).height < 0;
  return count == 2 ? is_behind_edge(point, used[0], used[1]) : is_behind_corner(point, used[0]);
}

bool SkinDistance::is_behind_edge(const glm::dvec3& point, std::uint32_t from, std::uint32_t to) {
  PlaneSide farthest;
  crossed_.clear();
  return look_at_edge(point, from, to, farthest) && farthest.height < 0;
}

/// Takes the farthest plane among the triangles on an edge. Returns whether skin goes on at both sides: whether the
/// edge runs forth in one triangle and back in another, however many there are.
bool SkinDistance::look_at_edge(const glm::dvec3& point, std::uint32_t from, std::uint32_t to, PlaneSide& farthest) {
  bool forth = false;
  bool back = false;
  for (const std::uint32_t triangle : neighbours_.triangles_around(from)) {
    const glm::uvec3& number = avatar_.triangles[triangle];
    const std::array numbers = {neighbours_.welded(number.x), neighbours_.welded(number.y),
                                neighbours_.welded(number.z)};
    const auto here = static_cast<std::size_t>(std::ranges::find(numbers, from) - numbers.begin());
    const std::uint32_t next = numbers[(here + 1) % 3];
    const std::uint32_t last = numbers[(here + 2) % 3];
    if ((next != to && last != to) || next == last || next == from || last == from) continue;
    const Corners corners = corners_of(triangle);
    const PlaneSide side = side_of(point, corners);
    if (side.squared_m2 > farthest.squared_m2) farthest = side;
    bool goes_on = true;
    if (!side.has_plane && std::ranges::find(crossed_, triangle) == crossed_.end()) {
      crossed_.push_back(triangle);
      const std::array places = {corners.a, corners.b, corners.c};
      const std::size_t third = (here + (next == to ? 2 : 1)) % 3;
      const std::size_t end = (here + (next == to ? 1 : 2)) % 3;
      const bool is_near_from = squared_distance_to_segment(point, places[here], places[third]) <=
                                squared_distance_to_segment(point, places[third], places[end]);
      goes_on = is_near_from ? look_at_edge(point, from, numbers[third], farthest)
                             : look_at_edge(point, numbers[third], to, farthest);
    }
    if (goes_on) (next == to ? forth : back) = true;
  }
  return forth && back;
}

bool SkinDistance::is_behind_corner(const glm::dvec3& point, std::uint32_t corner) {
  double steepest = -std::numeric_limits<double>::infinity();
  std::uint32_t towards = corner;
  for (const std::uint32_t triangle : neighbours_.triangles_around(corner)) {
    const glm::uvec3& number = avatar_.triangles[triangle];
    const Corners place = corners_of(triangle);
    const std::array numbers = {neighbours_.welded(number.x), neighbours_.welded(number.y),
                                neighbours_.welded(number.z)};
    const std::array places = {place.a, place.b, place.c};
    const auto here = static_cast<std::size_t>(std::ranges::find(numbers, corner) - numbers.begin());
    for (std::size_t i = 1; i < 3; ++i) {
      const std::size_t other = (here + i) % 3;
      const glm::dvec3 edge = places[other] - places[here];
      const double length = glm::dot(edge, edge);
      if (!(length > 0)) continue;
      const double along = glm::dot(point - places[here], edge);
      const double steepness = along * std::abs(along) / length;  // as the cosine of the angle, squared with its sign
      if (steepness <= steepest) continue;
      steepest = steepness;
      towards = numbers[other];
    }
  }
  return towards != corner && is_behind_edge(point, corner, towards);
}

}  // namespace vestige
