#pragma once

#include <algorithm>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <span>

namespace vestige {

/// The axis-aligned bounding box of a set of points, in the points' unit.
struct Box {
  glm::dvec3 low;
  glm::dvec3 high;

  glm::dvec3 extent() const { return high - low; }
  double longest_side() const { return std::max({extent().x, extent().y, extent().z}); }
};

/// Precondition: `points` is not empty.
inline Box box_around(std::span<const glm::dvec3> points) {
  Box box = {points.front(), points.front()};
  for (const glm::dvec3& point : points) box = {glm::min(box.low, point), glm::max(box.high, point)};
  return box;
}

}  // namespace vestige
