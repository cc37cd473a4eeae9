#pragma once

#include "detector/decision.hpp"

namespace vestige::test {

inline constexpr Corners kFloor = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};  // its front is up

inline Corners moved(const Corners& triangle, const glm::dvec3& way) {
  return {triangle.a + way, triangle.b + way, triangle.c + way};
}

}  // namespace vestige::test
