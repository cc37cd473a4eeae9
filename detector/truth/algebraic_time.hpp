#pragma once

#include <optional>
#include <vector>

#include "detector/truth/integer_polynomial.hpp"

namespace vestige::exact {

/// A root of a polynomial within [0, 1], exactly: a dyadic number, or the only root, a simple one, within an open
/// interval whose ends are dyadic. The interval shrinks as answers ask for it; the number stays the same.
class AlgebraicTime {
 public:
  /// x * 2^-scale. By value: g++ 12 falsely warns of uninitialised limbs otherwise.
  // NOLINTNEXTLINE(performance-unnecessary-value-param)
  AlgebraicTime(Whole x, unsigned scale) : interval_{x, x, scale} {}
  /// The only root of `polynomial` in `interval`; it is simple; just right of the interval's low end the polynomial has
  /// `sign_below`, which is not 0.
  AlgebraicTime(const Polynomial& polynomial, Interval interval, int sign_below)
      : polynomial_(polynomial), interval_(std::move(interval)), sign_below_(sign_below) {}

  /// The sign of `polynomial` at this time.
  int sign_of(const Polynomial& polynomial);
  /// -1, 0, 1: this time is before, equal to, after the other.
  int compare(AlgebraicTime& other);
  bool is_zero() const { return dyadic() && interval_.low == 0; }
  /// Nearest-even fp32.
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

/// The different roots of `polynomial` within [0, 1], in ascending order. Precondition: it does not vanish identically.
std::vector<AlgebraicTime> roots_within_frame(const Polynomial& polynomial);

}  // namespace vestige::exact
