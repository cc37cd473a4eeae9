#pragma once

#include <array>

#include "detector/decide/bounded.hpp"

namespace vestige {

// The formulas of the ccd filter whose errors are bounded, for any type of number, so that the tests can measure their
// roundings.

/// Returns a corner at time t of its motion.
template <typename Vector, typename Number>
Vector corner_at(const Vector& first, const Vector& last, Number t) {
  const Number rest = Number(1) - t;
  return {rest * first.x + t * last.x, rest * first.y + t * last.y, rest * first.z + t * last.z};
}

/// The Bernstein coefficients of a x b over a part of the motion; the middle coefficient is doubled.
template <typename Vector>
struct QuadraticVector {
  Vector first;
  Vector twice_middle;
  Vector last;
};

template <typename Vector>
QuadraticVector<Vector> quadratic_cross(const Vector& a0, const Vector& a1, const Vector& b0, const Vector& b1) {
  const Vector early_late = cross_product(a0, b1);
  const Vector late_early = cross_product(a1, b0);
  return {cross_product(a0, b0),
          {early_late.x + late_early.x, early_late.y + late_early.y, early_late.z + late_early.z},
          cross_product(a1, b1)};
}

/// Returns the Bernstein coefficients of a . (b x c) over a part of the motion; the two middle coefficients are
/// tripled.
template <typename Vector>
auto cubic_dot(const Vector& a0, const Vector& a1, const QuadraticVector<Vector>& bc) {
  return std::array{dot_product(a0, bc.first), dot_product(a1, bc.first) + dot_product(a0, bc.twice_middle),
                    dot_product(a0, bc.last) + dot_product(a1, bc.twice_middle), dot_product(a1, bc.last)};
}

// The error bounds. Let u = 2^-53. Every operation errs by at most u times its result (Higham, Accuracy and Stability
// of Numerical Algorithms, 2002, eq. 2.4 and 2.5). A difference of doubles errs by no more even if it is denormal. A,
// B, C are the corners relative to the point; each coordinate is a difference that was rounded once. M is, per axis,
// their largest absolute coordinate at t = 0 and 1, hence at any t between. First-order terms, in units of u:
//
//   A(t) = (1-t) A0 + t A1    differences 1, 1-t 1, products 1, sum 1                      4 Mi
//   (A x B)_k                 two products 4 + 4 + 1 each, difference 2 (it is <= 2)      20 Mi Mj
//   A0 x B1 + A1 x B0         twice that, sum 4; twice a Bernstein coefficient of A x B   44 Mi Mj
//   A . (B x C)               per axis 2*4 + 20 + 2, sums 4 + 6                          100 Mx My Mz
//   3 f1 = that + A0 . (..)   per axis 4*4 + 44 + 4, sums 8 + 12; last sum 18            330 Mx My Mz
//
// So 22 Mi Mj bounds the error of a Bernstein coefficient of A x B, and 110 Mx My Mz that of A . (B x C). The constants
// leave room for the terms of higher order and for the rounding of the bounds themselves.
inline constexpr double kAreaError = 24 * kUnit;
inline constexpr double kVolumeError = 128 * kUnit;

}  // namespace vestige
