#pragma once

#include <cstddef>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <span>

#include "detector/approximate/shape.hpp"
#include "detector/decision.hpp"

namespace vestige {

/// A box in any direction. Lengths are those of the space in which it was fitted.
struct OrientedBox {
  glm::dvec3 middle = glm::dvec3(0);
  glm::dmat3 axes = glm::dmat3(1);  ///< columns of length 1, perpendicular to each other
  glm::dvec3 half = glm::dvec3(0);  ///< half of each side

  /// The surface is cut into this many cells.
  static constexpr std::size_t kCellsAcross = 8;
  static constexpr std::size_t kCells = 6 * kCellsAcross * kCellsAcross;

  /// Returns a box around all corners: along the main axes of the area or along x, y, z, whichever has less volume.
  static OrientedBox fit(std::span<const Corners> triangles);

  /// Returns the box with every face moved outwards by `by`, or inwards. Where nothing is left, nothing is within it.
  OrientedBox grown(double by) const { return {middle, axes, half + by}; }
  /// Returns how far outside a point is, negative inside: exact except beyond edges and corners, where it is less.
  double height(const glm::dvec3& point) const;
  Chord chord(const glm::dvec3& start, const glm::dvec3& end) const;
  /// Returns the direction, of length 1, that points outwards at a point of the surface.
  glm::dvec3 normal(const glm::dvec3& point) const;
  /// Returns the cell of the surface that a point of the surface lies in.
  std::size_t cell(const glm::dvec3& point) const;
  glm::dvec3 middle_of_cell(std::size_t cell) const;
  /// Returns, for each axis, how far the box reaches from its middle once `matrix` has turned it.
  glm::dvec3 reach(const glm::dmat3& matrix) const;

 private:
  glm::dvec3 to_box(const glm::dvec3& point) const { return (point - middle) * axes; }
  /// The side that a point of the surface, seen from the box, lies on: its axis.
  int side(const glm::dvec3& point) const;
};

}  // namespace vestige
