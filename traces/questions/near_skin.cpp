#include "traces/questions/near_skin.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "traces/scene/reference_skinning.hpp"

namespace vestige {

namespace {

/// How far apart the points on a large triangle are.
constexpr double kSpacing_m = 0.04;
/// More points than these on one edge would be those of no body.
constexpr int kMostParts = 50;
/// How far the points leave the true distance open.
constexpr double kSlack_m = kSpacing_m / 2;
constexpr double kCell_m = NearPoints::kNear_m + kSlack_m;

int parts_of(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const double longest_m = std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
  return std::clamp(static_cast<int>(std::ceil(longest_m / kSpacing_m)), 1, kMostParts);
}

std::int64_t cell_at(double coordinate_m) {
  return static_cast<std::int64_t>(std::floor(coordinate_m / kCell_m));
}

/// Cells that are very far apart may share a key: then a distance is computed in vain.
std::uint64_t key_of(std::int64_t x, std::int64_t y, std::int64_t z) {
  constexpr std::uint64_t kMask = (std::uint64_t{1} << 21) - 1;
  const auto part = [](std::int64_t cell) { return static_cast<std::uint64_t>(cell) & kMask; };
  return part(x) << 42 | part(y) << 21 | part(z);
}

}  // namespace

SkinSampler::SkinSampler(const Avatar& avatar) : avatar_(avatar) {
  const std::vector<glm::dvec3> rest_m = skin_at_rest(avatar);
  std::vector<bool> has_point(rest_m.size());
  for (std::uint32_t t = 0; t < avatar.triangles.size(); ++t) {
    const glm::uvec3& corners = avatar.triangles[t];
    const int parts = parts_of(rest_m[corners.x], rest_m[corners.y], rest_m[corners.z]);
    for (int i = 0; i <= parts; ++i)
      for (int j = 0; i + j <= parts; ++j) {
        const int k = parts - i - j;
        if (std::max({i, j, k}) == parts) {
          const std::uint32_t corner = i == parts ? corners.x : j == parts ? corners.y : corners.z;
          if (has_point[corner]) continue;
          has_point[corner] = true;
        }
        points_.push_back({t, glm::dvec3(i, j, k) / static_cast<double>(parts)});
      }
  }
}

std::vector<glm::dvec3> SkinSampler::points_m(const Pose& pose) const {
  std::vector<glm::dvec3> vertices;
  skin_reference(avatar_, pose, glm::dvec3(0), vertices);
  std::vector<glm::dvec3> points;
  points.reserve(points_.size());
  for (const Point& point : points_) {
    const glm::uvec3& corners = avatar_.triangles[point.triangle];
    points.push_back(point.weight.x * vertices[corners.x] + point.weight.y * vertices[corners.y] +
                     point.weight.z * vertices[corners.z]);
  }
  return points;
}

NearPoints::NearPoints(std::vector<glm::dvec3> points_m) : points_m_(std::move(points_m)), box_(box_around(points_m_)) {
  for (std::uint32_t i = 0; i < points_m_.size(); ++i)
    in_cell_[key_of(cell_at(points_m_[i].x), cell_at(points_m_[i].y), cell_at(points_m_[i].z))].push_back(i);
}

bool NearPoints::is_near(const glm::dvec3& place_m) const {
  if (glm::any(glm::lessThan(place_m, box_.low - kCell_m)) || glm::any(glm::greaterThan(place_m, box_.high + kCell_m)))
    return false;
  for (std::int64_t x = cell_at(place_m.x) - 1; x <= cell_at(place_m.x) + 1; ++x)
    for (std::int64_t y = cell_at(place_m.y) - 1; y <= cell_at(place_m.y) + 1; ++y)
      for (std::int64_t z = cell_at(place_m.z) - 1; z <= cell_at(place_m.z) + 1; ++z) {
        const auto found = in_cell_.find(key_of(x, y, z));
        if (found == in_cell_.end()) continue;
        for (const std::uint32_t i : found->second)
          if (glm::distance(points_m_[i], place_m) <= kCell_m) return true;
      }
  return false;
}

double NearPoints::distance_m(const glm::dvec3& place_m, double most_m) const {
  const glm::dvec3 outside = glm::max(glm::max(box_.low - place_m, place_m - box_.high), glm::dvec3(0));
  if (glm::length(outside) >= most_m) return most_m;
  double least_m = most_m;
  for (const glm::dvec3& point : points_m_) least_m = std::min(least_m, glm::distance(point, place_m));
  return least_m;
}

}  // namespace vestige
