#pragma once

#include <optional>
#include <vector>

#include "detector/truth/integer_polynomial.hpp"

namespace vestige::exact {

/// A root of a polynomial within [0, 1], exactly. It is either a dyadic number, or a simple root that is the only root
/// in an open interval with dyadic ends. Queries shrink the interval as needed, but the number stays the same.
class AlgebraicTime {
 public:
  /// The time x * 2^-scale. x is passed by value because g++ 12 falsely warns of uninitialised limbs otherwise.
  // NOLINTNEXTLINE(performance-unnecessary-value-param)
  AlgebraicTime(Whole x, unsigned scale) : interval_{x, x, scale} {}
  /// The only root of `polynomial` in `interval`, which must be simple. Just right of the interval's low end the
  /// polynomial has the sign `sign_below`, which must not be 0.
  AlgebraicTime(const Polynomial& polynomial, Interval interval, int sign_below)
      : polynomial_(polynomial), interval_(std::move(interval)), sign_below_(sign_below) {}

  /// Returns the sign of `polynomial` at this time.
  int sign_of(const Polynomial& polynomial);
  /// Returns -1, 0 or 1 if this time is before, equal to or after the other time.
  int compare(AlgebraicTime& other);
  bool is_zero() const { return dyadic() && interval_.low == 0; }
  /// Returns the time rounded to nearest-even fp32.
  float rounded();

 private:
  bool dyadic() const { return sign_below_ == 0; }
  void refine();
  void bisect_at(const Whole& x);
  int compare_to(const Whole& x, unsigned scale);

  Polynomial polynomial_;
  Interval interval_;
  int sign_below_ = 0;
};

/// Returns the distinct roots of `polynomial` within [0, 1], in ascending order. The polynomial must not vanish
/// identically.
std::vector<AlgebraicTime> roots_within_frame(const Polynomial& polynomial);

}  // namespace vestige::exact
