#pragma once

#include <vector>

#include "detector/algebra/scaled_integers.hpp"

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
  /// Returns the sign just above or just below t >= 0. Returns 0 only for the zero polynomial.
  int sign_after(double t) const { return sign_beside(t, 1); }
  int sign_before(double t) const { return sign_beside(t, -1); }
  /// Returns the signs of the Bernstein coefficients on [low, high]. Between `low` and `high` there are at most as many
  /// roots as signs change along the list, and as many but for an even number. Requires 0 <= low < high, both finite.
  std::vector<int> bernstein_signs(double low, double high) const;
  /// Returns the sign throughout [low, high], if the Bernstein coefficients agree; otherwise 0.
  int constant_sign_on(double low, double high) const;

  /// Returns the sign between 0 and the first root above it. Returns 0 only for the zero polynomial.
  int sign_after_0() const;

  Polynomial derivative() const;
  /// Returns the polynomial divided by the highest powers of t and of t - 1 that divide it. The result has no roots at
  /// 0 and 1. The polynomial must not be zero.
  Polynomial without_end_roots() const;
  /// Requires that the divisor divides all coefficients.
  Polynomial divided_by(const Integer& divisor) const;

  friend Polynomial operator-(Polynomial a);
  friend Polynomial operator+(const Polynomial& a, const Polynomial& b);
  friend Polynomial operator-(const Polynomial& a, const Polynomial& b);
  friend Polynomial operator*(const Polynomial& a, const Polynomial& b);

 private:
  int sign_beside(double t, int side) const;

  std::vector<Integer> coefficients_;
};

/// Returns a / b. b must divide a, and the coefficients of b must have no common divisor.
Polynomial quotient(const Polynomial& a, const Polynomial& b);

}  // namespace vestige
