#pragma once

#include <array>
#include <cstddef>

#include "detector/truth/whole_number.hpp"

namespace vestige::exact {

inline constexpr int kMaxDegree = 6;

/// A polynomial in time with integer coefficients, of degree `kMaxDegree` at most.
class Polynomial {
 public:
  Polynomial() = default;
  /// Returns at_0 + (at_1 - at_0) t.
  static Polynomial moving(const Whole& at_0, const Whole& at_1);

  /// Returns the degree, or -1 if the polynomial vanishes identically.
  int degree() const { return degree_; }
  bool vanishes() const { return degree_ < 0; }
  /// Returns the coefficient of t^power; 0 above the degree.
  const Whole& operator[](int power) const { return coefficient_[static_cast<std::size_t>(power)]; }

  Polynomial derivative() const;

  friend Polynomial operator+(const Polynomial& a, const Polynomial& b);
  friend Polynomial operator-(const Polynomial& a, const Polynomial& b);
  /// The sum of the degrees must be kMaxDegree at most.
  friend Polynomial operator*(const Polynomial& a, const Polynomial& b);
  /// Returns a greatest common divisor, up to a constant. It vanishes only if both polynomials do.
  friend Polynomial common_divisor(Polynomial a, Polynomial b);
  /// Returns a / b up to a constant. b must divide a and must not vanish.
  friend Polynomial quotient_of(Polynomial a, const Polynomial& b);

 private:
  void drop_leading_zeros(int from);
  void drop_content();
  void reduce_by(const Polynomial& divisor, Polynomial* quotient);

  std::array<Whole, kMaxDegree + 1> coefficient_;
  int degree_ = -1;
};

using MovingVector = std::array<Polynomial, 3>;
MovingVector operator-(const MovingVector& a, const MovingVector& b);
Polynomial dot(const MovingVector& a, const MovingVector& b);
MovingVector cross(const MovingVector& a, const MovingVector& b);

/// The open time interval (low, high) * 2^-scale.
struct Interval {
  Whole low = 0;
  Whole high = 1;
  unsigned scale = 0;
};

/// Returns the sign of `polynomial` at x * 2^-scale.
int sign_at(const Polynomial& polynomial, const Whole& x, unsigned scale);

/// The coefficients of a polynomial over an interval in the Bernstein basis of the polynomial's degree, all times one
/// positive number. The first and the last coefficient have the polynomial's signs at the ends of the interval.
struct Bernstein {
  std::array<Whole, kMaxDegree + 1> coefficient;
  int degree = -1;

  /// Returns the number of sign changes, zeros left out. It equals the number of roots in the open interval, counted
  /// with multiplicity, or exceeds that number by an even number (Descartes' rule of signs; Basu, Pollack, Roy,
  /// "Algorithms in Real Algebraic Geometry", 10.2).
  int sign_changes() const;
  /// Returns the sign just right of the interval's low end, or 0 if the polynomial vanishes.
  int first_sign() const;
};
Bernstein bernstein(const Polynomial& polynomial, const Interval& interval);

}  // namespace vestige::exact
