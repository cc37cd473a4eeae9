#include "detector/nearest_in_triangle.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

namespace vestige {

glm::dvec3 nearest_in_triangle(const glm::dvec3& p, const Corners& triangle) {
  const auto& [a, b, c] = triangle;
  const glm::dvec3 ab = b - a;
  const glm::dvec3 ac = c - a;
  const double d1 = glm::dot(ab, p - a);
  const double d2 = glm::dot(ac, p - a);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  const double d3 = glm::dot(ab, p - b);
  const double d4 = glm::dot(ac, p - b);
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {1 - d1 / (d1 - d3), d1 / (d1 - d3), 0};
  const double d5 = glm::dot(ab, p - c);
  const double d6 = glm::dot(ac, p - c);
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {1 - d2 / (d2 - d6), 0, d2 / (d2 - d6)};
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) {
    const double share = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {0, 1 - share, share};
  }
  const double sum = va + vb + vc;
  return {va / sum, vb / sum, vc / sum};
}

glm::dvec3 nearest_on_edges(const glm::dvec3& p, const Corners& triangle) {
  const std::array corner = {triangle.a, triangle.b, triangle.c};
  glm::dvec3 nearest(0);
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    const int next = (i + 1) % 3;
    const glm::dvec3& from = corner[static_cast<std::size_t>(i)];
    const glm::dvec3 edge = corner[static_cast<std::size_t>(next)] - from;
    const double length = glm::dot(edge, edge);
    const double share = length > 0 ? std::clamp(glm::dot(p - from, edge) / length, 0.0, 1.0) : 0.0;
    const glm::dvec3 away = from + share * edge - p;
    if (const double distance = glm::dot(away, away); distance < least) {
      least = distance;
      nearest = glm::dvec3(0);
      nearest[i] = 1 - share;
      nearest[next] = share;
    }
  }
  return nearest;
}

bool are_shares(const glm::dvec3& weights) {
  for (int i = 0; i < 3; ++i)
    if (!(weights[i] >= 0 && weights[i] <= 1)) return false;  // NaN is none, either
  return true;
}

double squared_distance_to_box(const glm::dvec3& point, const glm::dvec3& low, const glm::dvec3& high) {
  const glm::dvec3 away = glm::max(glm::max(low - point, point - high), glm::dvec3(0));
  return glm::dot(away, away);
}

glm::dvec3 weighed(const glm::dvec3& weights, const Corners& triangle) {
  return weights.x * triangle.a + weights.y * triangle.b + weights.z * triangle.c;
}

}  // namespace vestige
