#pragma once

#include <cstddef>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <span>

#include "detector/approximate/shape.hpp"
#include "detector/decision.hpp"

namespace vestige {

/// All points within `radius` of a segment along an axis. Lengths are those of the space in which it was fitted.
struct Capsule {
  glm::dvec3 middle = glm::dvec3(0);
  glm::dmat3 axes =
      glm::dmat3(1);       ///< columns of length 1, perpendicular to each other; the segment lies along the first
  double half_length = 0;  ///< half of the segment
  double radius = 0;

  /// The surface is cut into this many cells: along the capsule, ends included, and around it.
  static constexpr std::size_t kCellsAlong = 16;
  static constexpr std::size_t kCellsAround = 16;
  static constexpr std::size_t kCells = kCellsAlong * kCellsAround;

  /// Fits a capsule to a surface. It lies along the longest main axis of the area. Its radius is the mean distance of
  /// the area from that axis, and its ends are where the surface ends. Skin lies on both sides of a capsule's surface.
  static Capsule fit(std::span<const Corners> triangles);

  /// Returns the capsule with its surface moved outwards by `by`, or inwards. Where nothing is left, nothing is within
  /// it.
  Capsule grown(double by) const { return {middle, axes, half_length, radius + by}; }
  /// Returns the distance of a point from the surface, negative inside.
  double height(const glm::dvec3& point) const;
  Chord chord(const glm::dvec3& start, const glm::dvec3& end) const;
  /// Returns the direction, of length 1, that points outwards at a point of the surface.
  glm::dvec3 normal(const glm::dvec3& point) const;
  /// Returns the cell of the surface that a point of the surface lies in.
  std::size_t cell(const glm::dvec3& point) const;
  glm::dvec3 middle_of_cell(std::size_t cell) const;
  /// Returns, for each axis, how far the capsule reaches from its middle once `matrix` has turned it.
  glm::dvec3 reach(const glm::dmat3& matrix) const;
};

}  // namespace vestige
