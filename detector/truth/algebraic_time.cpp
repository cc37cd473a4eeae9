#include "detector/truth/algebraic_time.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace vestige::exact {

namespace {

constexpr unsigned kRefinementBits = 40;

/// Returns an approximate root, in (0, 1) of the interval, of a Bernstein polynomial with one sign change. The result
/// is a guess, and the caller must check it.
double guessed_root(const Bernstein& exact) {
  constexpr int kSteps = 48;
  constexpr unsigned kKeptBits = 900;  // far from overflow
  unsigned longest = 0;
  for (const Whole& coefficient : exact.coefficient)
    if (coefficient != 0) longest = std::max(longest, static_cast<unsigned>(msb(abs(coefficient))));
  std::array<double, kMaxDegree + 1> rounded = {};
  for (std::size_t i = 0; i < rounded.size(); ++i)
    rounded[i] = static_cast<double>(longest > kKeptBits ? Whole(exact.coefficient[i] >> (longest - kKeptBits))
                                                         : exact.coefficient[i]);
  const auto value_at = [&rounded, &exact](double s) {
    std::array<double, kMaxDegree + 1> level = rounded;  // de Casteljau's scheme
    for (int top = exact.degree; top > 0; --top)
      for (std::size_t i = 0; i < static_cast<std::size_t>(top); ++i) level[i] += s * (level[i + 1] - level[i]);
    return level[0];
  };
  const bool negative_first = exact.first_sign() < 0;
  double low = 0;
  double high = 1;
  for (int i = 0; i < kSteps; ++i) {
    const double middle = 0.5 * (low + high);
    ((value_at(middle) < 0) == negative_first ? low : high) = middle;
  }
  return low;
}

Interval rescaled(const Interval& interval, unsigned scale) {
  const unsigned more = scale - interval.scale;
  return {interval.low << more, interval.high << more, scale};
}

}  // namespace

/// Cuts the interval at x, given in the scale of the interval, if x lies in the interval.
void AlgebraicTime::bisect_at(const Whole& x) {
  if (dyadic() || x <= interval_.low || x >= interval_.high) return;
  const int sign = sign_at(polynomial_, x, interval_.scale);
  if (sign == 0) {
    interval_ = {x, x, interval_.scale};
    sign_below_ = 0;
  } else {
    (sign == sign_below_ ? interval_.low : interval_.high) = x;
  }
}

/// Shrinks the interval to at most half of its width. If the floating-point guess is right, the new width is at most
/// 2^-38 of the old.
void AlgebraicTime::refine() {
  if (dyadic()) return;
  const double guess = guessed_root(bernstein(polynomial_, interval_));
  const Whole step = interval_.high - interval_.low;
  interval_ = rescaled(interval_, interval_.scale + kRefinementBits);
  const Whole start = interval_.low;
  const auto nearest = static_cast<std::int64_t>(std::ldexp(guess, kRefinementBits));
  bisect_at(start + step * (nearest - 1));
  bisect_at(start + step * (nearest + 2));
  const Whole width = interval_.high - interval_.low;
  if (width > (step << (kRefinementBits - 1))) bisect_at(start + (step << (kRefinementBits - 1)));
}

int AlgebraicTime::sign_of(const Polynomial& polynomial) {
  constexpr int kQuickTries = 2;
  for (int tries = 0;; ++tries) {
    if (dyadic()) return sign_at(polynomial, interval_.low, interval_.scale);
    const Bernstein over_interval = bernstein(polynomial, interval_);
    if (over_interval.sign_changes() == 0) return over_interval.first_sign();
    if (tries == kQuickTries) {
      // A simple root of polynomial_ is at most a simple root of the common divisor, so an odd count means exactly one
      // root.
      const Polynomial common = common_divisor(polynomial_, polynomial);
      if (bernstein(common, interval_).sign_changes() % 2 != 0) return 0;
    }
    refine();
  }
}

/// Returns the sign of this time minus x * 2^-scale.
int AlgebraicTime::compare_to(const Whole& x, unsigned scale) {
  const unsigned common = std::max(scale, interval_.scale);
  const Interval interval = rescaled(interval_, common);
  const Whole other = x << (common - scale);
  if (dyadic()) return interval.low.compare(other) > 0 ? 1 : (interval.low == other ? 0 : -1);
  if (other <= interval.low) return 1;
  if (other >= interval.high) return -1;
  return sign_at(polynomial_, x, scale) * sign_below_;
}

int AlgebraicTime::compare(AlgebraicTime& other) {
  constexpr int kQuickTries = 2;
  for (int tries = 0;; ++tries) {
    if (other.dyadic()) return compare_to(other.interval_.low, other.interval_.scale);
    if (dyadic()) return -other.compare_to(interval_.low, interval_.scale);
    const unsigned scale = std::max(interval_.scale, other.interval_.scale);
    const Interval mine = rescaled(interval_, scale);
    const Interval its = rescaled(other.interval_, scale);
    if (mine.high <= its.low) return -1;
    if (mine.low >= its.high) return 1;
    if (tries == kQuickTries) {
      const Polynomial common = common_divisor(polynomial_, other.polynomial_);
      const Interval both = {std::max(mine.low, its.low), std::min(mine.high, its.high), scale};
      if (bernstein(common, both).sign_changes() % 2 != 0) return 0;
    }
    refine();
    other.refine();
  }
}

float AlgebraicTime::rounded() {
  constexpr unsigned kMiddleScale = 150;  // every midpoint of two neighbouring floats is a multiple of 2^-150
  for (;;) {
    const Whole one = Whole(1) << interval_.scale;
    const float low = rounded_quotient(interval_.low, one);
    if (dyadic()) return low;
    const float high = rounded_quotient(interval_.high, one);
    if (low == high) return low;
    if (std::nextafter(low, high) == high) {
      const double middle = 0.5 * (static_cast<double>(low) + static_cast<double>(high));
      const BinaryParts parts = binary_parts(middle);
      const Whole x = Whole(parts.significand) << (static_cast<unsigned>(parts.exponent + int{kMiddleScale}));
      const int side = compare_to(x, kMiddleScale);
      return side == 0 ? rounded_quotient(x, Whole(1) << kMiddleScale) : (side < 0 ? low : high);
    }
    refine();
  }
}

std::vector<AlgebraicTime> roots_within_frame(const Polynomial& polynomial) {
  constexpr unsigned kPatience = 16;
  std::vector<AlgebraicTime> roots;
  roots.reserve(kMaxDegree);
  if (sign_at(polynomial, 0, 0) == 0) roots.emplace_back(0, 0U);
  std::vector<Interval> open = {Interval()};
  while (!open.empty()) {
    const Interval interval = open.back();
    open.pop_back();
    const Bernstein over_interval = bernstein(polynomial, interval);
    const int changes = over_interval.sign_changes();
    if (changes == 1) roots.emplace_back(polynomial, interval, over_interval.first_sign());
    if (changes > 1) {
      if (interval.scale == kPatience) {  // roots this close may be one root, which no bisection can tell
        const Polynomial repeated = common_divisor(polynomial, polynomial.derivative());
        if (repeated.degree() > 0) return roots_within_frame(quotient_of(polynomial, repeated));
      }
      const Interval halves = rescaled(interval, interval.scale + 1);
      const Whole middle = halves.low + (interval.high - interval.low);
      open.push_back({middle, halves.high, halves.scale});
      open.push_back({halves.low, middle, halves.scale});
    }
    if (changes <= 1) {
      // The interval's high end is the next dyadic number that may be a root.
      if (sign_at(polynomial, interval.high, interval.scale) == 0) roots.emplace_back(interval.high, interval.scale);
    }
  }
  return roots;
}

}  // namespace vestige::exact
