#include "traces/places/skin_walk.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace vestige {

namespace {

constexpr std::uint32_t kNoTriangle = 0xFFFFFFFF;
constexpr std::uint32_t kNoCorner = 3;
constexpr double kShortestStep_s = 1e-4;  // least duration of a step, so that slivers cannot stop time
constexpr double kTurn = 0.4;             // radians
constexpr double kResting_s = 1;          // duration of a step where there is no path

struct Edge {
  std::array<std::uint32_t, 2> ends;
  std::uint32_t side = 0;  // 3 * triangle + corner opposite to it
};

}  // namespace

SkinPoint SkinStep::at(double time_s) const {
  const double share = std::clamp((time_s - start_s) / (end_s - start_s), 0.0, 1.0);
  return {from.triangle, glm::mix(from.weight, to_weight, share)};
}

SkinWalk::SkinWalk(const Skin& skin, double speed_m_per_s, double straight_m)
    : skin_(skin), speed_m_per_s_(speed_m_per_s), straight_m_(straight_m) {
  const auto& triangles = skin.avatar().triangles;
  neighbours_.assign(3 * triangles.size(), kNoTriangle);
  std::vector<Edge> edges;
  for (std::uint32_t triangle = 0; triangle < triangles.size(); ++triangle) {
    if (!(glm::length(normal_of(triangle)) > 0)) continue;
    for (std::uint32_t corner = 0; corner < 3; ++corner) {
      const std::uint32_t one = skin.weld()[triangles[triangle][static_cast<int>((corner + 1) % 3)]];
      const std::uint32_t other = skin.weld()[triangles[triangle][static_cast<int>((corner + 2) % 3)]];
      edges.push_back({{std::min(one, other), std::max(one, other)}, 3 * triangle + corner});
    }
  }
  std::ranges::sort(edges,
                    [](const Edge& a, const Edge& b) { return a.ends != b.ends ? a.ends < b.ends : a.side < b.side; });
  // If more than two triangles share an edge, they are joined in pairs.
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    if (edges[i].ends != edges[i + 1].ends) continue;
    neighbours_[edges[i].side] = edges[i + 1].side / 3;
    neighbours_[edges[i + 1].side] = edges[i].side / 3;
    ++i;
  }
}

const glm::dvec3& SkinWalk::corner_m(std::uint32_t triangle, std::uint32_t corner) const {
  return skin_.rest_m()[skin_.avatar().triangles[triangle][static_cast<int>(corner)]];
}

glm::dvec3 SkinWalk::normal_of(std::uint32_t triangle) const {
  const glm::dvec3& a = corner_m(triangle, 0);
  return glm::cross(corner_m(triangle, 1) - a, corner_m(triangle, 2) - a);
}

SkinStep SkinWalk::step_from(double start_s, const SkinPoint& from, const glm::dvec3& heading) const {
  SkinStep step{start_s, start_s + kResting_s, from, from.weight, heading, kNoCorner};
  const glm::dvec3 normal = normal_of(from.triangle);
  const double squared = glm::dot(normal, normal);
  if (!(squared > 0)) return step;

  double length_m = straight_m_;
  glm::dvec3 rate(0);  // change of the weights per metre
  for (std::uint32_t i = 0; i < 3; ++i) {
    const auto k = static_cast<int>(i);
    rate[k] = glm::dot(glm::cross(normal, corner_m(from.triangle, (i + 2) % 3) - corner_m(from.triangle, (i + 1) % 3)),
                       heading) /
              squared;
    if (rate[k] < 0 && from.weight[k] < -rate[k] * length_m) {
      length_m = from.weight[k] / -rate[k];
      step.exit_corner = i;
    }
  }
  step.to_weight = glm::max(from.weight + length_m * rate, glm::dvec3(0));
  if (step.exit_corner != kNoCorner) step.to_weight[static_cast<int>(step.exit_corner)] = 0;
  step.to_weight /= step.to_weight.x + step.to_weight.y + step.to_weight.z;
  step.end_s = start_s + std::max(length_m / speed_m_per_s_, kShortestStep_s);
  return step;
}

SkinStep SkinWalk::begin(double time_s, Random& random) const {
  const SkinPoint point = skin_.random_point(random);
  glm::dvec3 heading = glm::cross(normal_of(point.triangle), random.direction());
  const double length = glm::length(heading);
  heading = length > 0 ? heading / length : glm::dvec3(1, 0, 0);
  return step_from(time_s, point, heading);
}

/// Crosses the edge at which the step ended. If there is nothing beyond the edge, stays on the same side.
SkinWalk::Crossing SkinWalk::cross(const SkinStep& step) const {
  const auto& triangles = skin_.avatar().triangles;
  const std::vector<std::uint32_t>& weld = skin_.weld();
  const auto exit = static_cast<int>(step.exit_corner);
  const glm::uvec3 left = triangles[step.from.triangle];
  const std::uint32_t one = left[(exit + 1) % 3];
  const std::uint32_t other = left[(exit + 2) % 3];
  Crossing crossing{{step.from.triangle, step.to_weight}, glm::dvec3(0), glm::dvec3(0)};
  std::uint32_t ahead = left[exit];
  const std::uint32_t neighbour = neighbours_[3 * step.from.triangle + step.exit_corner];
  if (neighbour != kNoTriangle) {
    crossing.point = {neighbour, glm::dvec3(0)};
    for (int corner = 0; corner < 3; ++corner) {
      const std::uint32_t vertex = triangles[neighbour][corner];
      if (weld[vertex] == weld[one]) {
        crossing.point.weight[corner] = step.to_weight[(exit + 1) % 3];
      } else if (weld[vertex] == weld[other]) {
        crossing.point.weight[corner] = step.to_weight[(exit + 2) % 3];
      } else {
        ahead = vertex;
      }
    }
  }
  const std::vector<glm::dvec3>& rest_m = skin_.rest_m();
  const glm::dvec3 along = glm::normalize(rest_m[other] - rest_m[one]);
  const glm::dvec3 side = rest_m[ahead] - rest_m[one];
  crossing.inwards = glm::normalize(side - glm::dot(side, along) * along);
  const double kept = std::clamp(glm::dot(step.heading, along), -1.0, 1.0);
  crossing.heading = kept * along + std::sqrt(1 - kept * kept) * crossing.inwards;
  return crossing;
}

SkinStep SkinWalk::next(const SkinStep& step, Random& random) const {
  const double angle = random.uniform(-kTurn, kTurn);
  Crossing start{{step.from.triangle, step.to_weight}, step.heading, glm::dvec3(0)};
  if (step.exit_corner != kNoCorner) start = cross(step);
  const glm::dvec3 normal = normal_of(start.point.triangle);
  const double length = glm::length(normal);
  if (length > 0) {
    const glm::dvec3 turned =
        std::cos(angle) * start.heading + std::sin(angle) * glm::cross(normal / length, start.heading);
    // A turn must not lead back across the edge just crossed.
    if (glm::dot(turned, start.inwards) >= 0) start.heading = turned;
  }
  return step_from(step.end_s, start.point, start.heading);
}

}  // namespace vestige
