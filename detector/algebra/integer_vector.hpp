#pragma once

#include <array>

#include "detector/algebra/scaled_integers.hpp"

namespace vestige {

/// A vector of integers, for signs that must be exact.
using IntegerVector = std::array<Integer, 3>;

inline IntegerVector minus(const IntegerVector& a, const IntegerVector& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

inline Integer dot(const IntegerVector& a, const IntegerVector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline IntegerVector cross(const IntegerVector& a, const IntegerVector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

inline bool is_zero(const IntegerVector& a) {
  return a[0].is_zero() && a[1].is_zero() && a[2].is_zero();
}

}  // namespace vestige
