#pragma once

#include <array>
#include <cstddef>

#include "detector/algebra/moving_polynomials.hpp"
#include "detector/decision.hpp"

namespace vestige {

/// A moving triangle as seen from a moving sphere, as polynomials in t with whole numbers, all in one unit.
struct RelativeTriangle {
  std::array<PolynomialVector, 3> corner;  ///< relative to the centre, each linear in t
  Integer radius;
};

inline RelativeTriangle relative_triangle(const MovingSphere& sphere, const Corners& before, const Corners& after) {
  constexpr std::size_t kPoints = 4;
  std::array<double, 6 * kPoints + 1> values = {};
  std::size_t next = 0;
  for (const glm::dvec3* point :
       {&sphere.centre.start, &before.a, &before.b, &before.c, &sphere.centre.end, &after.a, &after.b, &after.c})
    for (int axis = 0; axis < 3; ++axis) values[next++] = (*point)[axis];
  values[next] = sphere.radius;
  const std::array<Integer, 6 * kPoints + 1> whole = scaled_integers(values);
  RelativeTriangle triangle = {{}, whole[next]};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t place = 3 * (i + 1) + axis;
      const Integer at_0 = whole[place] - whole[axis];
      const Integer at_1 = whole[place + 3 * kPoints] - whole[axis + 3 * kPoints];
      triangle.corner[i][axis] = Polynomial({at_0, Integer(at_1 - at_0)});
    }
  }
  return triangle;
}

}  // namespace vestige
