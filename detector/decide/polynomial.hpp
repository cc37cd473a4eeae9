#pragma once

#include <span>
#include <vector>

#include "detector/decide/scaled_integers.hpp"

namespace vestige {

/// A polynomial in t with whole coefficients, exact. The coefficient of t^i is `coefficients()[i]`; the last is not
/// zero; the zero polynomial has none, and degree -1.
class Polynomial {
 public:
  Polynomial() = default;
  explicit Polynomial(std::vector<Integer> coefficients);

  bool is_zero() const { return coefficients_.empty(); }
  int degree() const { return static_cast<int>(coefficients_.size()) - 1; }
  const std::vector<Integer>& coefficients() const { return coefficients_; }
  const Integer& leading() const { return coefficients_.back(); }

  int sign_at_0() const { return is_zero() ? 0 : coefficients_.front().sign(); }
  int sign_at_1() const;
  /// The sign at a finite t >= 0.
  int sign_at(double t) const;
  /// The sign throughout [low, high], 0 <= low < high finite, if a polynomial of degree <= 2 shows it at a glance (its
  /// Bernstein coefficients agree); else 0.
  int constant_sign_on(double low, double high) const;

  /// The sign between 0 and the first root above it. 0 for the zero polynomial only.
  int sign_after_0() const;

  Polynomial derivative() const;
  /// Divided by the highest powers of t and of t - 1 that divide it: without roots at 0 and 1. Not zero.
  Polynomial without_end_roots() const;

  friend Polynomial operator+(const Polynomial& a, const Polynomial& b);
  friend Polynomial operator-(const Polynomial& a, const Polynomial& b);
  friend Polynomial operator*(const Polynomial& a, const Polynomial& b);

 private:
  std::vector<Integer> coefficients_;
};

/// A positive multiple of the remainder of a / b. b is not zero.
Polynomial remainder(const Polynomial& a, const Polynomial& b);

/// A multiple, not zero, of a / b, which leaves no remainder.
Polynomial quotient(const Polynomial& a, const Polynomial& b);

/// a, b, and then each time the negative remainder of the two before, until none is left: the signed remainder sequence
/// of Basu, Pollack, Roy, Algorithms in Real Algebraic Geometry (2006), definition 1.7, up to positive factors.
std::vector<Polynomial> signed_remainders(const Polynomial& a, const Polynomial& b);

/// How often the sign changes along a list, zeros left out.
int sign_changes(std::span<const int> signs);

}  // namespace vestige
