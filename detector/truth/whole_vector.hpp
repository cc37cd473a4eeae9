#pragma once

#include <array>

#include "detector/truth/whole_number.hpp"

namespace vestige::exact {

using Vector = std::array<Whole, 3>;

inline Vector minus(const Vector& a, const Vector& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Whole dot(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline bool is_zero(const Vector& v) {
  return v[0] == 0 && v[1] == 0 && v[2] == 0;
}

}  // namespace vestige::exact
