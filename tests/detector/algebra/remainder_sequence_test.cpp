// Remainder sequences: their signs, and how slowly their coefficients grow.

#include "detector/algebra/remainder_sequence.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <random>
#include <vector>

#include "detector/algebra/exact_quotient.hpp"

namespace vestige {
namespace {

using Rational = boost::multiprecision::cpp_rational;
using RationalPolynomial = std::vector<Rational>;

RationalPolynomial rational(const Polynomial& polynomial) {
  RationalPolynomial result;
  result.reserve(polynomial.coefficients().size());
  for (const Integer& coefficient : polynomial.coefficients())
    result.emplace_back(static_cast<boost::multiprecision::cpp_int>(coefficient));
  return result;
}

RationalPolynomial negative_remainder(RationalPolynomial a, const RationalPolynomial& b) {
  while (a.size() >= b.size()) {
    const Rational factor = a.back() / b.back();
    for (std::size_t i = 0; i < b.size(); ++i) a[a.size() - b.size() + i] -= factor * b[i];
    a.pop_back();
  }
  while (!a.empty() && a.back() == 0) a.pop_back();
  for (Rational& coefficient : a) coefficient = -coefficient;
  return a;
}

bool is_positive_multiple(const RationalPolynomial& a, const RationalPolynomial& b) {
  if (a.size() != b.size() || a.empty()) return false;
  const Rational factor = a.back() / b.back();
  const auto is_multiple = [&factor](const Rational& x, const Rational& y) { return x == y * factor; };
  return factor > 0 && std::ranges::equal(a, b, is_multiple);
}

Integer random_integer(std::mt19937& engine, unsigned bits) {
  Integer result = 0;
  for (unsigned i = 0; i < bits; ++i) result = 2 * result + static_cast<int>(engine() % 2);
  return engine() % 2 == 0 ? result : Integer(-result);
}

TEST(RemainderSequence, HasTheSignsOfRationalRemaindersHoweverFarDegreesDrop) {
  std::mt19937 engine(1);
  const auto sparse = [&engine](std::size_t size) {
    std::vector<Integer> coefficients(size);
    for (Integer& coefficient : coefficients)
      if (engine() % 2 == 0) coefficient = static_cast<int>(engine() % 9) - 4;
    coefficients.back() = engine() % 2 == 0 ? 3 : -2;
    return Polynomial(std::move(coefficients));
  };
  int drops = 0;
  for (int i = 0; i < 2000; ++i) {
    SCOPED_TRACE(i);
    Polynomial b = sparse(2 + engine() % 6);
    Polynomial a = sparse(b.coefficients().size() + engine() % 4);
    if (i % 4 == 0) {
      const Polynomial common = sparse(2 + engine() % 2);
      a = a * common;
      b = b * common;
    }
    const std::vector<Polynomial> sequence = signed_remainders(a, b);
    for (std::size_t j = 2; j < sequence.size(); ++j) {
      const RationalPolynomial expected = negative_remainder(rational(sequence[j - 2]), rational(sequence[j - 1]));
      ASSERT_TRUE(is_positive_multiple(rational(sequence[j]), expected)) << j;
      drops += j > 2 && sequence[j].degree() + 1 < sequence[j - 1].degree() ? 1 : 0;
    }
    const std::size_t size = sequence.size();
    ASSERT_TRUE(negative_remainder(rational(sequence[size - 2]), rational(sequence[size - 1])).empty());
  }
  EXPECT_GT(drops, 50);
}

TEST(RemainderSequence, GrowsInProportionToTheDegree) {
  std::mt19937 engine(2);
  std::vector<Integer> coefficients(7);
  for (Integer& coefficient : coefficients) coefficient = random_integer(engine, 300);
  const Polynomial polynomial(std::move(coefficients));
  const std::vector<Polynomial> sequence = signed_remainders(polynomial, polynomial.derivative());
  ASSERT_EQ(sequence.size(), 7U);
  for (const Polynomial& remainder : sequence) {
    if (remainder.degree() == 0) continue;  // only the constant is not divided, since nothing follows it
    for (const Integer& coefficient : remainder.coefficients())
      EXPECT_LT(msb(abs(coefficient)), 310U * static_cast<unsigned>(13 - 2 * remainder.degree()));
  }
}

TEST(RemainderSequence, GivesTheRepeatedPartWithoutACommonDivisor) {
  const Polynomial twice({Integer(-3), Integer(7)});
  const Polynomial thrice({Integer(-2), Integer(0), Integer(5)});
  const Polynomial expected = twice * thrice * thrice;
  const Polynomial product = expected * twice * thrice * Polynomial({Integer(60)});
  const Polynomial repeated = repeated_part(signed_remainders(product, product.derivative()));
  EXPECT_TRUE(repeated.coefficients() == expected.coefficients() ||
              repeated.coefficients() == (-expected).coefficients());
  EXPECT_EQ((quotient(product, repeated) * repeated).coefficients(), product.coefficients());
}

TEST(ExactQuotient, IsWhatWasMultiplied) {
  std::mt19937 engine(3);
  const auto up_to = [&engine](unsigned most) { return std::uniform_int_distribution<unsigned>(0, most)(engine); };
  for (int i = 0; i < 2000; ++i) {
    const Integer a = random_integer(engine, up_to(700)) << up_to(130);
    Integer b = random_integer(engine, 1 + up_to(700)) << up_to(130);
    if (b.is_zero()) b = -1;
    ASSERT_EQ(exact_quotient(a * b, b), a) << a << " " << b;
  }
  const Integer ones = (Integer(1) << 640U) - 1;  // borrows run through all limbs
  EXPECT_EQ(exact_quotient(ones * ones, ones), ones);
  EXPECT_EQ(exact_quotient(ones * 3, -3), -ones);
}

}  // namespace
}  // namespace vestige
