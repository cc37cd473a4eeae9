#include "detector/decide/polynomial.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

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
  while (exponent < 0 && whole % 2 == 0) {
    whole /= 2;
    ++exponent;
  }
  return exponent < 0 ? Dyadic{whole, static_cast<unsigned>(-exponent)} : Dyadic{whole << exponent, 0};
}

/// Divides by the powers of two that all coefficients have in common.
std::vector<Integer> without_common_twos(std::vector<Integer> coefficients) {
  unsigned twos = std::numeric_limits<unsigned>::max();
  for (const Integer& coefficient : coefficients)
    if (!coefficient.is_zero()) twos = std::min(twos, boost::multiprecision::lsb(abs(coefficient)));
  for (Integer& coefficient : coefficients)
    if (!coefficient.is_zero()) coefficient >>= twos;
  return coefficients;
}

/// One step of a division: returns a |lead(b)| - b t^k (sign of lead(b)) lead(a), which has a smaller degree than a.
std::vector<Integer> division_step(const std::vector<Integer>& a, const std::vector<Integer>& b) {
  const Integer scale = abs(b.back());
  const Integer factor = b.back().sign() > 0 ? a.back() : Integer(-a.back());
  std::vector<Integer> rest(a.begin(), a.end() - 1);
  for (Integer& coefficient : rest) coefficient *= scale;
  const std::size_t shift = a.size() - b.size();
  for (std::size_t i = 0; i + 1 < b.size(); ++i) rest[i + shift] -= factor * b[i];
  return rest;
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

int Polynomial::constant_sign_on(double low, double high) const {
  const int sign = sign_at(low);
  if (sign == 0 || sign_at(high) != sign) return 0;
  if (degree() < 2) return sign;
  // The middle Bernstein coefficient is the polar form: c0 + c1 (low + high) / 2 + c2 low high.
  Dyadic from = dyadic(low);
  Dyadic to = dyadic(high);
  const unsigned places = std::max(from.places, to.places);
  const Integer from_whole = Integer(from.whole) << (places - from.places);
  const Integer to_whole = Integer(to.whole) << (places - to.places);
  Integer middle = coefficients_[0] << (2 * places + 1);
  middle += (coefficients_[1] * (from_whole + to_whole)) << places;
  middle += (coefficients_[2] * from_whole * to_whole) << 1U;
  return middle.sign() == sign ? sign : 0;
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

Polynomial remainder(const Polynomial& a, const Polynomial& b) {
  Polynomial rest = a;
  while (rest.degree() >= b.degree()) rest = Polynomial(division_step(rest.coefficients(), b.coefficients()));
  if (rest.is_zero()) return rest;
  return Polynomial(without_common_twos(rest.coefficients()));
}

Polynomial quotient(const Polynomial& a, const Polynomial& b) {
  Polynomial result;
  Polynomial rest = a;
  while (rest.degree() >= b.degree()) {
    const auto shift = static_cast<std::size_t>(rest.degree() - b.degree());
    std::vector<Integer> term(shift + 1);
    term[shift] = b.leading().sign() > 0 ? rest.leading() : Integer(-rest.leading());
    result = result * Polynomial({Integer(abs(b.leading()))}) + Polynomial(std::move(term));
    rest = Polynomial(division_step(rest.coefficients(), b.coefficients()));
  }
  return Polynomial(without_common_twos(result.coefficients()));
}

std::vector<Polynomial> signed_remainders(const Polynomial& a, const Polynomial& b) {
  std::vector<Polynomial> sequence = {a};
  if (!b.is_zero()) sequence.push_back(b);
  while (sequence.size() > 1) {
    Polynomial next = Polynomial() - remainder(sequence[sequence.size() - 2], sequence.back());
    if (next.is_zero()) break;
    sequence.push_back(std::move(next));
  }
  return sequence;
}

int sign_changes(std::span<const int> signs) {
  int changes = 0;
  int last = 0;
  for (const int sign : signs) {
    if (sign == 0) continue;
    if (last == -sign) ++changes;
    last = sign;
  }
  return changes;
}

}  // namespace vestige
