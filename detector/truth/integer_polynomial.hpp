#pragma once

#include <array>
#include <cstddef>

#include "detector/truth/whole_number.hpp"

namespace vestige::exact {

inline constexpr int kMaxDegree = 3;

/// A polynomial in time with whole coefficients, of degree `kMaxDegree` at most.
class Polynomial {
 public:
  Polynomial() = default;
  /// at_0 + (at_1 - at_0) t
  static Polynomial moving(const Whole& at_0, const Whole& at_1);

  /// -1 where it vanishes identically.
  int degree() const { return degree_; }
  bool vanishes() const { return degree_ < 0; }
  /// Of t^power; 0 above the degree.
  const Whole& operator[](int power) const { return coefficient_[static_cast<std::size_t>(power)]; }

  Polynomial derivative() const;

  friend Polynomial operator+(const Polynomial& a, const Polynomial& b);
  friend Polynomial operator-(const Polynomial& a, const Polynomial& b);
  /// Precondition: the degrees' sum is kMaxDegree at most.
  friend Polynomial operator*(const Polynomial& a, const Polynomial& b);
  /// A greatest common divisor, up to a constant. Vanishes only where both do.
  friend Polynomial common_divisor(Polynomial a, Polynomial b);
  /// a / b up to a constant. Precondition: b divides a, b does not vanish.
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

/// The open interval of times (low, high) * 2^-scale.
struct Interval {
  Whole low = 0;
  Whole high = 1;
  unsigned scale = 0;
};

/// The sign of `polynomial` at x * 2^-scale.
int sign_at(const Polynomial& polynomial, const Whole& x, unsigned scale);

/// The coefficients of `polynomial` over `interval` in the Bernstein basis of its degree, all times one positive
/// number. The first and last have the signs at the interval's ends.
struct Bernstein {
  std::array<Whole, kMaxDegree + 1> coefficient;
  int degree = -1;

  /// Changes of sign, zeros left out: as many as there are roots in the open interval, each counted as often as it is
  /// one, or more by an even number (Descartes' rule of signs; Basu, Pollack, Roy, "Algorithms in Real Algebraic
  /// Geometry", 10.2).
  int sign_changes() const;
  /// The sign just right of the interval's low end. 0 where the polynomial vanishes.
  int first_sign() const;
};
Bernstein bernstein(const Polynomial& polynomial, const Interval& interval);

}  // namespace vestige::exact
