#pragma once

#include <span>
#include <vector>

#include "detector/decide/scaled_integers.hpp"

namespace vestige {

/// A polynomial in t with integer coefficients, exact. The coefficient of t^i is `coefficients()[i]`. The last
/// coefficient is not zero. The zero polynomial has no coefficients, and its degree is -1.
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
  /// Returns the sign at a finite t >= 0.
  int sign_at(double t) const;
  /// Returns the sign throughout [low, high], if the Bernstein coefficients of the polynomial agree; otherwise 0.
  /// Requires degree <= 2 and 0 <= low < high, both finite.
  int constant_sign_on(double low, double high) const;

  /// Returns the sign between 0 and the first root above it. Returns 0 only for the zero polynomial.
  int sign_after_0() const;

  Polynomial derivative() const;
  /// Returns the polynomial divided by the highest powers of t and of t - 1 that divide it. The result has no roots at
  /// 0 and 1. The polynomial must not be zero.
  Polynomial without_end_roots() const;

  friend Polynomial operator+(const Polynomial& a, const Polynomial& b);
  friend Polynomial operator-(const Polynomial& a, const Polynomial& b);
  friend Polynomial operator*(const Polynomial& a, const Polynomial& b);

 private:
  std::vector<Integer> coefficients_;
};

/// Returns a positive multiple of the remainder of a / b. b must not be zero.
Polynomial remainder(const Polynomial& a, const Polynomial& b);

/// Returns a non-zero multiple of a / b. b must divide a.
Polynomial quotient(const Polynomial& a, const Polynomial& b);

/// Returns a, b, and then repeatedly the negative remainder of the last two, until the remainder is zero: the signed
/// remainder sequence of Basu, Pollack, Roy, Algorithms in Real Algebraic Geometry (2006), definition 1.7, up to
/// positive factors.
std::vector<Polynomial> signed_remainders(const Polynomial& a, const Polynomial& b);

/// Returns the number of sign changes along a list, zeros left out.
int sign_changes(std::span<const int> signs);

}  // namespace vestige
