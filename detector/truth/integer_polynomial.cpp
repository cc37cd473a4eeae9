#include "detector/truth/integer_polynomial.hpp"

#include <algorithm>
#include <utility>

namespace vestige::exact {

namespace {

constexpr std::size_t index_of(int power) {
  return static_cast<std::size_t>(power);
}

}  // namespace

Polynomial Polynomial::moving(const Whole& at_0, const Whole& at_1) {
  Polynomial result;
  result.coefficient_[0] = at_0;
  result.coefficient_[1] = at_1 - at_0;
  result.drop_leading_zeros(1);
  return result;
}

void Polynomial::drop_leading_zeros(int from) {
  degree_ = from;
  while (degree_ >= 0 && (*this)[degree_] == 0) --degree_;
}

void Polynomial::drop_content() {
  if (degree_ < 0) return;
  Whole content;
  for (const Whole& coefficient : coefficient_) content = gcd(content, coefficient);
  for (Whole& coefficient : coefficient_) coefficient /= content;
}

Polynomial Polynomial::derivative() const {
  Polynomial result;
  for (int power = 1; power <= degree_; ++power) result.coefficient_[index_of(power - 1)] = (*this)[power] * power;
  result.degree_ = std::max(degree_ - 1, -1);
  return result;
}

Polynomial operator+(const Polynomial& a, const Polynomial& b) {
  Polynomial sum = a;
  for (int power = 0; power <= b.degree_; ++power) sum.coefficient_[index_of(power)] += b[power];
  sum.drop_leading_zeros(std::max(a.degree_, b.degree_));
  return sum;
}

Polynomial operator-(const Polynomial& a, const Polynomial& b) {
  Polynomial difference = a;
  for (int power = 0; power <= b.degree_; ++power) difference.coefficient_[index_of(power)] -= b[power];
  difference.drop_leading_zeros(std::max(a.degree_, b.degree_));
  return difference;
}

Polynomial operator*(const Polynomial& a, const Polynomial& b) {
  Polynomial product;
  if (a.vanishes() || b.vanishes()) return product;
  for (int i = 0; i <= a.degree_; ++i)
    for (int j = 0; j <= b.degree_; ++j) product.coefficient_[index_of(i + j)] += a[i] * b[j];
  product.degree_ = a.degree_ + b.degree_;
  return product;
}

/// Replaces `this` by its remainder, times a power of the divisor's leading coefficient. If `quotient` is not null, it
/// receives the factor of the divisor for that multiple.
void Polynomial::reduce_by(const Polynomial& divisor, Polynomial* quotient) {
  const Whole leading = divisor[divisor.degree_];
  while (degree_ >= divisor.degree_) {
    const int shift = degree_ - divisor.degree_;
    const Whole factor = (*this)[degree_];
    for (Whole& coefficient : coefficient_) coefficient *= leading;
    for (int power = 0; power <= divisor.degree_; ++power)
      coefficient_[index_of(power + shift)] -= factor * divisor[power];
    if (quotient != nullptr) {
      for (Whole& coefficient : quotient->coefficient_) coefficient *= leading;
      quotient->coefficient_[index_of(shift)] += factor;
    }
    drop_leading_zeros(degree_ - 1);
  }
}

Polynomial common_divisor(Polynomial a, Polynomial b) {
  a.drop_content();
  b.drop_content();
  if (a.degree_ < b.degree_) std::swap(a, b);
  while (!b.vanishes()) {
    a.reduce_by(b, nullptr);
    a.drop_content();
    std::swap(a, b);
  }
  return a;
}

Polynomial quotient_of(Polynomial a, const Polynomial& b) {
  Polynomial quotient;
  const int degree = a.degree_ - b.degree_;
  a.reduce_by(b, &quotient);
  quotient.degree_ = degree;
  quotient.drop_content();
  return quotient;
}

MovingVector operator-(const MovingVector& a, const MovingVector& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

Polynomial dot(const MovingVector& a, const MovingVector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

MovingVector cross(const MovingVector& a, const MovingVector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

int sign_at(const Polynomial& polynomial, const Whole& x, unsigned scale) {
  Whole value;
  for (int power = polynomial.degree(); power >= 0; --power)
    value = value * x + (polynomial[power] << (scale * static_cast<unsigned>(polynomial.degree() - power)));
  return sign_of(value);
}

int Bernstein::sign_changes() const {
  int changes = 0;
  int last = 0;
  for (int i = 0; i <= degree; ++i) {
    const int sign = sign_of(coefficient[index_of(i)]);
    if (sign == 0) continue;
    if (last != 0 && sign != last) ++changes;
    last = sign;
  }
  return changes;
}

int Bernstein::first_sign() const {
  for (int i = 0; i <= degree; ++i) {
    const int sign = sign_of(coefficient[index_of(i)]);
    if (sign != 0) return sign;
  }
  return 0;
}

Bernstein bernstein(const Polynomial& polynomial, const Interval& interval) {
  Bernstein result;
  const int degree = polynomial.degree();
  result.degree = degree;
  if (degree < 0) return result;
  auto& c = result.coefficient;
  for (int power = 0; power <= degree; ++power)
    c[index_of(power)] = polynomial[power] << (interval.scale * static_cast<unsigned>(degree - power));
  // t = low + s (high - low): Taylor's shift by Horner's scheme, then the stretch.
  if (interval.low != 0)
    for (int i = 0; i < degree; ++i)
      for (int power = degree - 1; power >= i; --power) c[index_of(power)] += c[index_of(power + 1)] * interval.low;
  const Whole width = interval.high - interval.low;
  Whole stretch = 1;
  // sum_j c_j s^j has the Bernstein coefficients b_i = sum_j (i over j) / (n over j) c_j. All are multiplied by the
  // least common multiple of the (n over j), so that they are integers. The sums are Pascal's triangle: repeated sums
  // of neighbours.
  constexpr std::array<std::array<int, kMaxDegree + 1>, kMaxDegree + 1> kFactor = {
      {{1}, {1, 1}, {2, 1, 2}, {3, 1, 1, 3}, {12, 3, 2, 3, 12}, {10, 2, 1, 1, 2, 10}, {60, 10, 4, 3, 4, 10, 60}}};
  for (int power = 0; power <= degree; ++power) {
    c[index_of(power)] *= stretch;
    c[index_of(power)] *= kFactor[index_of(degree)][index_of(power)];
    stretch *= width;
  }
  for (int i = 1; i <= degree; ++i)
    for (int power = degree; power >= i; --power) c[index_of(power)] += c[index_of(power - 1)];
  return result;
}

}  // namespace vestige::exact
