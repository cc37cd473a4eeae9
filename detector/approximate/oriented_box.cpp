#include "detector/approximate/oriented_box.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

namespace vestige {

namespace {

OrientedBox around(std::span<const Corners> triangles, const glm::dmat3& axes) {
  glm::dvec3 low(std::numeric_limits<double>::infinity());
  glm::dvec3 high = -low;
  for (const auto& [a, b, c] : triangles)
    for (const glm::dvec3& corner : {a, b, c}) {
      const glm::dvec3 along = corner * axes;
      low = glm::min(low, along);
      high = glm::max(high, along);
    }
  return {axes * ((low + high) / 2.0), axes, (high - low) / 2.0};
}

double volume(const OrientedBox& box) {
  return box.half.x * box.half.y * box.half.z;
}

/// The cell, of kCellsAcross, that a place in [-half, half] falls into.
std::size_t cell_along(double place, double half) {
  const double share = half > 0 ? std::clamp((place / half + 1) / 2, 0.0, 1.0) : 0.5;
  return std::min(static_cast<std::size_t>(share * OrientedBox::kCellsAcross), OrientedBox::kCellsAcross - 1);
}

double middle_along(std::size_t cell, double half) {
  return half * ((2.0 * static_cast<double>(cell) + 1) / OrientedBox::kCellsAcross - 1);
}

}  // namespace

OrientedBox OrientedBox::fit(std::span<const Corners> triangles) {
  const OrientedBox straight = around(triangles, glm::dmat3(1));
  const OrientedBox turned = around(triangles, main_axes(triangles).axes);
  return volume(straight) <= volume(turned) ? straight : turned;
}

double OrientedBox::height(const glm::dvec3& point) const {
  const glm::dvec3 out = glm::abs(to_box(point)) - half;
  return std::max({out.x, out.y, out.z});
}

Chord OrientedBox::chord(const glm::dvec3& start, const glm::dvec3& end) const {
  const glm::dvec3 position = to_box(start);
  const glm::dvec3 speed = (end - start) * axes;
  Chord chord;
  for (int axis = 0; axis < 3; ++axis) chord = within_slab(chord, position[axis], speed[axis], half[axis]);
  return chord;
}

int OrientedBox::side(const glm::dvec3& point) const {
  const glm::dvec3 depth = half - glm::abs(point);
  return depth.x <= depth.y && depth.x <= depth.z ? 0 : (depth.y <= depth.z ? 1 : 2);
}

glm::dvec3 OrientedBox::normal(const glm::dvec3& point) const {
  const glm::dvec3 inside = to_box(point);
  const int axis = side(inside);
  return inside[axis] < 0 ? -axes[axis] : axes[axis];
}

std::size_t OrientedBox::cell(const glm::dvec3& point) const {
  const glm::dvec3 inside = to_box(point);
  const int axis = side(inside);
  const int across = (axis + 1) % 3;
  const int up = (axis + 2) % 3;
  const std::size_t face = static_cast<std::size_t>(2 * axis) + (inside[axis] < 0 ? 1 : 0);
  return (face * kCellsAcross + cell_along(inside[up], half[up])) * kCellsAcross +
         cell_along(inside[across], half[across]);
}

glm::dvec3 OrientedBox::middle_of_cell(std::size_t cell) const {
  const std::size_t face = cell / (kCellsAcross * kCellsAcross);
  const auto axis = static_cast<int>(face / 2);
  const int across = (axis + 1) % 3;
  const int up = (axis + 2) % 3;
  glm::dvec3 inside(0);
  inside[axis] = face % 2 == 0 ? half[axis] : -half[axis];
  inside[up] = middle_along(cell / kCellsAcross % kCellsAcross, half[up]);
  inside[across] = middle_along(cell % kCellsAcross, half[across]);
  return middle + axes * inside;
}

glm::dvec3 OrientedBox::reach(const glm::dmat3& matrix) const {
  const glm::dmat3 turned = matrix * axes;
  return glm::abs(turned[0]) * half.x + glm::abs(turned[1]) * half.y + glm::abs(turned[2]) * half.z;
}

}  // namespace vestige
