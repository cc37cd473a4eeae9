#include "detector/algebra/remainder_sequence.hpp"

#include <utility>

#include "detector/algebra/exact_quotient.hpp"

namespace vestige {

namespace {

Integer power(const Integer& base, int exponent) {
  Integer result = 1;
  for (int i = 0; i < exponent; ++i) result *= base;
  return result;
}

/// Returns the remainder of |lead(b)|^(drop + 1) a / b, where `drop` is by how much the degree of b is lower.
Polynomial pseudo_remainder(const Polynomial& a, const Polynomial& b) {
  const Integer scale = abs(b.leading());
  const std::vector<Integer>& divisor = b.coefficients();
  std::vector<Integer> rest = a.coefficients();
  while (rest.size() >= divisor.size()) {
    const Integer factor = b.leading().sign() > 0 ? rest.back() : Integer(-rest.back());
    rest.pop_back();
    for (Integer& coefficient : rest) coefficient *= scale;
    if (factor.is_zero()) continue;
    const std::size_t shift = rest.size() + 1 - divisor.size();
    for (std::size_t i = 0; i + 1 < divisor.size(); ++i) rest[i + shift] -= factor * divisor[i];
  }
  return Polynomial(std::move(rest));
}

}  // namespace

std::vector<Polynomial> signed_remainders(const Polynomial& a, const Polynomial& b) {
  std::vector<Polynomial> sequence;
  sequence.reserve(b.coefficients().size() + 1);
  sequence.push_back(a);
  if (!b.is_zero()) sequence.push_back(b);
  // The lead that a regular sequence would have had in the place of the last dividend, Brown's psi; without its sign.
  Integer regular_lead = 1;
  while (sequence.size() > 1 && sequence.back().degree() > 0) {
    const Polynomial& dividend = sequence[sequence.size() - 2];
    const Polynomial& divisor = sequence.back();
    const int drop = dividend.degree() - divisor.degree();
    Polynomial next = -pseudo_remainder(dividend, divisor);
    if (next.is_zero()) break;
    // Nothing follows a constant, so only its sign matters.
    if (sequence.size() > 2 && next.degree() > 0)
      next = next.divided_by(abs(dividend.leading()) * power(regular_lead, drop));
    if (drop > 0) regular_lead = exact_quotient(power(abs(divisor.leading()), drop), power(regular_lead, drop - 1));
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

int changes_lost(std::span<const Polynomial> sequence, double low, double high) {
  std::vector<int> at_low;
  std::vector<int> at_high;
  at_low.reserve(sequence.size());
  at_high.reserve(sequence.size());
  for (const Polynomial& polynomial : sequence) {
    at_low.push_back(polynomial.sign_after(low));
    at_high.push_back(polynomial.sign_before(high));
  }
  return sign_changes(at_low) - sign_changes(at_high);
}

int cauchy_index(const Polynomial& polynomial, const Polynomial& other, double low, double high) {
  if (other.degree() < polynomial.degree()) return changes_lost(signed_remainders(polynomial, other), low, high);
  // The sequence of `polynomial` and the remainder of `other`, which has the same Cauchy index.
  const std::vector<Polynomial> sequence = signed_remainders(-other, polynomial);
  return changes_lost(std::span(sequence).subspan(1), low, high);
}

Polynomial repeated_part(std::span<const Polynomial> remainders) {
  const Polynomial& last = remainders.back();
  if (last.degree() < 1) return last;
  // Without its common divisor, the lead divides that of the polynomial. This shortens the coefficients before their
  // common divisor is searched.
  std::vector<Integer> scaled = last.coefficients();
  Integer common = 0;
  for (Integer& coefficient : scaled) {
    coefficient = exact_quotient(coefficient * remainders.front().leading(), last.leading());
    common = gcd(common, coefficient);
  }
  return Polynomial(std::move(scaled)).divided_by(common);
}

}  // namespace vestige
