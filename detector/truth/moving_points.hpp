#pragma once

#include <array>
#include <cstddef>

#include "detector/decision.hpp"
#include "detector/truth/integer_polynomial.hpp"

namespace vestige::exact {

/// The centre of a sphere (0) and the corners of a triangle (1 to 3), moving, as whole multiples of one length.
class MovingPoints {
 public:
  MovingPoints(const MovingSphere& sphere, const Corners& before, const Corners& after) {
    std::array<double, 25> values = {};
    std::size_t next = 0;
    for (const glm::dvec3* point :
         {&sphere.centre.start, &sphere.centre.end, &before.a, &after.a, &before.b, &after.b, &before.c, &after.c})
      for (int axis = 0; axis < 3; ++axis) values[next++] = (*point)[axis];
    values[next] = sphere.radius;
    whole_ = whole_multiples(values);
  }

  MovingVector difference(std::size_t from, std::size_t to) const {
    MovingVector vector;
    for (std::size_t axis = 0; axis < 3; ++axis)
      vector[axis] = Polynomial::moving(whole_[6 * to + axis] - whole_[6 * from + axis],
                                        whole_[6 * to + 3 + axis] - whole_[6 * from + 3 + axis]);
    return vector;
  }

  const Whole& radius() const { return whole_[24]; }

 private:
  std::array<Whole, 25> whole_;
};

}  // namespace vestige::exact
