#pragma once

#include <cfloat>
#include <cmath>

namespace vestige {

static_assert(FLT_EVAL_METHOD == 0, "the bounds need every operation rounded to its type");
#ifdef __FAST_MATH__
#error "fast-math breaks the bounds"
#endif

/// Half the distance from 1 to the next double: the largest relative error of one rounded operation.
inline constexpr double kUnit = 0x1p-53;

/// A computed number, and its largest possible distance from the exact number.
struct Bounded {
  double value = 0;
  double error = 0;

  bool sure() const { return std::abs(value) > error; }
  bool surely_positive() const { return value > error; }
  bool surely_negative() const { return value < -error; }
};

// The formulas whose errors are bounded. Each is written once, for any type of number, so that the tests can count its
// roundings.

template <typename Vector>
Vector difference(const Vector& a, const Vector& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

template <typename Vector>
Vector cross_product(const Vector& v, const Vector& w) {
  return {v.y * w.z - v.z * w.y, v.z * w.x - v.x * w.z, v.x * w.y - v.y * w.x};
}

template <typename Vector>
auto dot_product(const Vector& u, const Vector& v) {
  return (u.x * v.x + u.y * v.y) + u.z * v.z;
}

/// The error of dot_product(u, cross_product(v, w)) for differences u, v, w, in units of its permanent (the same sum
/// over the absolute values of its terms). Each term contains the rounding of three differences, of two products, of
/// the subtraction within the cross product and of two additions: at most 8 factors (1 + e), |e| <= kUnit. So the sum
/// errs by at most 8 kUnit / (1 - 8 kUnit) of the permanent (Higham 2002, Accuracy and Stability of Numerical
/// Algorithms, Lemma 3.1). The permanent is itself computed with at most 8 such factors. The factor 1 + 32 kUnit covers
/// both.
inline constexpr double kTripleError = 8 * kUnit * (1 + 32 * kUnit);

}  // namespace vestige
