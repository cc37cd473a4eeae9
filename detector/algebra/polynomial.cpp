#include "detector/algebra/polynomial.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <utility>

#include "detector/algebra/exact_quotient.hpp"

namespace vestige {

namespace {

/// A double >= 0 as whole / 2^places, with the smallest possible `places`.
struct Dyadic {
  std::int64_t whole = 0;
  unsigned places = 0;
};

Dyadic dyadic(double value) {
  if (value == 0) return {};
  constexpr int kDigits = std::numeric_limits<double>::digits;
  int exponent = 0;
  auto whole = static_cast<std::int64_t>(std::ldexp(std::frexp(value, &exponent), kDigits));
  exponent -= kDigits;
  if (exponent < 0) {
    const int twos = std::min(-exponent, std::countr_zero(static_cast<std::uint64_t>(whole)));
    whole >>= twos;
    exponent += twos;
  }
  return exponent < 0 ? Dyadic{whole, static_cast<unsigned>(-exponent)} : Dyadic{whole << exponent, 0};
}

}  // namespace

Polynomial::Polynomial(std::vector<Integer> coefficients) : coefficients_(std::move(coefficients)) {
  while (!coefficients_.empty() && coefficients_.back().is_zero()) coefficients_.pop_back();
}

int Polynomial::sign_at_1() const {
  Integer sum = 0;
  for (const Integer& coefficient : coefficients_) sum += coefficient;
  return sum.sign();
}

int Polynomial::sign_at(double t) const {
  const Dyadic at = dyadic(t);
  Integer value = 0;
  unsigned places = 0;
  for (auto coefficient = coefficients_.rbegin(); coefficient != coefficients_.rend(); ++coefficient) {
    value *= at.whole;
    value += Integer(*coefficient << places);
    places += at.places;
  }
  return value.sign();
}

int Polynomial::sign_beside(double t, int side) const {
  // The first derivative that does not vanish at t tells.
  int mirror = 1;
  for (Polynomial derived = *this; !derived.is_zero(); derived = derived.derivative()) {
    const int sign = derived.sign_at(t);
    if (sign != 0) return sign * mirror;
    mirror *= side;
  }
  return 0;
}

std::vector<int> Polynomial::bernstein_signs(double low, double high) const {
  if (is_zero()) return {};
  const Dyadic from = dyadic(low);
  const Dyadic to = dyadic(high);
  const unsigned places = std::max(from.places, to.places);
  const Integer from_whole = Integer(from.whole) << (places - from.places);
  const Integer to_whole = Integer(to.whole) << (places - to.places);
  // Horner's scheme for t = low (1 - s) + high s. row[i] is the coefficient of (1 - s)^(degree - i) s^i, a positive
  // multiple of the Bernstein coefficient. To raise the degree by one, a constant is multiplied by (1 - s) + s.
  std::vector<Integer> row;
  row.reserve(coefficients_.size());
  row.push_back(leading());
  unsigned shift = 0;
  for (std::size_t j = coefficients_.size() - 1; j-- > 0;) {
    shift += places;
    Integer added = coefficients_[j] << shift;
    const std::size_t size = row.size();
    row.push_back(row.back() * to_whole + added);
    std::size_t binomial = 1;
    for (std::size_t i = size - 1; i > 0; --i) {
      binomial = binomial * (i + 1) / (size - i);
      row[i] *= from_whole;
      row[i] += row[i - 1] * to_whole;
      row[i] += added * binomial;
    }
    row[0] *= from_whole;
    row[0] += added;
  }
  std::vector<int> signs;
  signs.reserve(row.size());
  for (const Integer& coefficient : row) signs.push_back(coefficient.sign());
  return signs;
}

int Polynomial::constant_sign_on(double low, double high) const {
  const std::vector<int> signs = bernstein_signs(low, high);
  return std::ranges::adjacent_find(signs, std::not_equal_to<>()) == signs.end() && !signs.empty() ? signs[0] : 0;
}

int Polynomial::sign_after_0() const {
  for (const Integer& coefficient : coefficients_)
    if (!coefficient.is_zero()) return coefficient.sign();
  return 0;
}

Polynomial Polynomial::derivative() const {
  std::vector<Integer> derived;
  derived.reserve(coefficients_.size());
  for (std::size_t i = 1; i < coefficients_.size(); ++i) derived.emplace_back(coefficients_[i] * i);
  return Polynomial(std::move(derived));
}

Polynomial Polynomial::without_end_roots() const {
  const auto nonzero = [](const Integer& coefficient) { return !coefficient.is_zero(); };
  std::vector<Integer> rest(std::ranges::find_if(coefficients_, nonzero), coefficients_.end());
  Polynomial polynomial(std::move(rest));
  while (polynomial.sign_at_1() == 0) {
    // Horner's scheme at 1 leaves the quotient, and the remainder zero.
    std::vector<Integer>& coefficients = polynomial.coefficients_;
    for (std::size_t i = coefficients.size() - 1; i-- > 0;) coefficients[i] += coefficients[i + 1];
    coefficients.erase(coefficients.begin());
  }
  return polynomial;
}

Polynomial Polynomial::divided_by(const Integer& divisor) const {
  Polynomial result = *this;
  for (Integer& coefficient : result.coefficients_) coefficient = exact_quotient(coefficient, divisor);
  return result;
}

Polynomial operator-(Polynomial a) {
  for (Integer& coefficient : a.coefficients_) coefficient = -coefficient;
  return a;
}

Polynomial operator+(const Polynomial& a, const Polynomial& b) {
  const bool longer = a.coefficients_.size() >= b.coefficients_.size();
  std::vector<Integer> sum = longer ? a.coefficients_ : b.coefficients_;
  const std::vector<Integer>& added = longer ? b.coefficients_ : a.coefficients_;
  for (std::size_t i = 0; i < added.size(); ++i) sum[i] += added[i];
  return Polynomial(std::move(sum));
}

Polynomial operator-(const Polynomial& a, const Polynomial& b) {
  std::vector<Integer> difference = a.coefficients_;
  difference.resize(std::max(a.coefficients_.size(), b.coefficients_.size()));
  for (std::size_t i = 0; i < b.coefficients_.size(); ++i) difference[i] -= b.coefficients_[i];
  return Polynomial(std::move(difference));
}

Polynomial operator*(const Polynomial& a, const Polynomial& b) {
  if (a.is_zero() || b.is_zero()) return {};
  std::vector<Integer> product(a.coefficients_.size() + b.coefficients_.size() - 1);
  for (std::size_t i = 0; i < a.coefficients_.size(); ++i)
    for (std::size_t j = 0; j < b.coefficients_.size(); ++j)
      product[i + j] += Integer(a.coefficients_[i] * b.coefficients_[j]);
  return Polynomial(std::move(product));
}

Polynomial quotient(const Polynomial& a, const Polynomial& b) {
  // By Gauss's lemma, all coefficients are integers.
  const std::vector<Integer>& divisor = b.coefficients();
  std::vector<Integer> rest = a.coefficients();
  std::vector<Integer> result(rest.size() - divisor.size() + 1);
  for (std::size_t shift = result.size(); shift-- > 0;) {
    result[shift] = exact_quotient(rest[shift + divisor.size() - 1], divisor.back());
    for (std::size_t i = 0; i < divisor.size(); ++i) rest[i + shift] -= result[shift] * divisor[i];
  }
  return Polynomial(std::move(result));
}

}  // namespace vestige
