// Roots that are asked, not approximated.

#include "detector/algebra/unit_roots.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <boost/multiprecision/cpp_int.hpp>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <utility>
#include <vector>

namespace vestige {
namespace {

/// 2^60 (t - root), for a root of at most 60 binary places.
Polynomial zero_at(double root) {
  return Polynomial({Integer(static_cast<std::int64_t>(-root * 0x1p60)), Integer(1) << 60U});
}

TEST(UnitRoots, LeaveOutTheEndsAndWhatLiesBeyond) {
  const UnitRoots roots(zero_at(0) * zero_at(0.25) * zero_at(1));
  ASSERT_EQ(roots.count(), 1U);
  EXPECT_EQ(roots.rounded(0), 0.25F);
  EXPECT_EQ(UnitRoots(zero_at(-0.5) * zero_at(2)).count(), 0U);
  EXPECT_EQ(UnitRoots(Polynomial({Integer(7)})).count(), 0U);
  EXPECT_EQ(UnitRoots(Polynomial({Integer(1), Integer(0), Integer(1)})).count(), 0U) << "t^2 + 1";
}

TEST(UnitRoots, AreIrrationalTooAndRoundedRight) {
  const UnitRoots roots(Polynomial({Integer(-1), Integer(0), Integer(2)}));  // 2 t^2 = 1
  ASSERT_EQ(roots.count(), 1U);
  EXPECT_EQ(roots.rounded(0), 0.70710678F);
  EXPECT_EQ(roots.sign_at(0, Polynomial({Integer(-1), Integer(0), Integer(2)})), 0);
  EXPECT_EQ(roots.sign_at(0, zero_at(0.70710678118654746)), 1);  // the doubles around the root
  EXPECT_EQ(roots.sign_at(0, zero_at(0.70710678118654757)), -1);
}

TEST(UnitRoots, KnowSignsHoweverCloseTheyLie) {
  const std::array<double, 3> at = {0.5, 0.5 + 0x1p-50, 0.5 + 0x1p-49};
  for (const double scale : {1.0, -1.0}) {
    const Polynomial factor({Integer(static_cast<int>(scale))});
    const UnitRoots three(factor * zero_at(at[0]) * zero_at(at[1]) * zero_at(at[2]));
    ASSERT_EQ(three.count(), 3U);
    const UnitRoots two(factor * zero_at(at[0]) * zero_at(at[2]) * zero_at(4));
    ASSERT_EQ(two.count(), 2U);
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        const int order = i == j ? 0 : (i > j ? 1 : -1);
        EXPECT_EQ(three.sign_at(i, zero_at(at[j])), order) << i << " " << j;
        EXPECT_EQ(three.sign_at(i, zero_at(at[j]) * zero_at(-1)), order) << i << " " << j;
        if (i == 1) continue;
        EXPECT_EQ(two.sign_at(i / 2, zero_at(at[j]) * zero_at(-1)), order) << i << " " << j;
      }
    }
  }
}

TEST(UnitRoots, TellTouchesFromCrossings) {
  const UnitRoots roots(zero_at(0.25) * zero_at(0.75) * zero_at(0.75));
  ASSERT_EQ(roots.count(), 2U);
  EXPECT_FALSE(roots.is_even(0));
  EXPECT_TRUE(roots.is_even(1));
  EXPECT_EQ(roots.rounded(1), 0.75F);
  const UnitRoots triple(zero_at(0.375) * zero_at(0.375) * zero_at(0.375));
  ASSERT_EQ(triple.count(), 1U);
  EXPECT_FALSE(triple.is_even(0));
}

TEST(UnitRoots, AreOrderedAmongThoseOfOtherPolynomials) {
  const std::array<double, 4> at = {0.5, 0.5 + 0x1p-52, 0.5 + 0x1p-51, 0.75};
  const UnitRoots first(zero_at(at[0]) * zero_at(at[2]) * zero_at(at[3]));
  const UnitRoots second(zero_at(at[1]) * zero_at(at[2]) * zero_at(at[2]));  // has a root in common, twice
  ASSERT_EQ(second.count(), 2U);
  const std::array<double, 3> of_first = {at[0], at[2], at[3]};
  const std::array<double, 2> of_second = {at[1], at[2]};
  for (std::size_t i = 0; i < of_first.size(); ++i)
    for (std::size_t j = 0; j < of_second.size(); ++j) {
      EXPECT_EQ(first.is_before(i, second, j), of_first[i] < of_second[j]) << i << " " << j;
      EXPECT_EQ(second.is_before(j, first, i), of_second[j] < of_first[i]) << i << " " << j;
    }
}

using Rational = boost::multiprecision::cpp_rational;

Rational to_power_of_two(int exponent) {
  const Rational power = boost::multiprecision::cpp_int(1) << std::abs(exponent);
  return exponent < 0 ? 1 / power : power;
}

/// rational + of_root_2 sqrt(2): the numbers among which the truth is computed.
struct Number {
  Rational rational;
  Rational of_root_2 = 0;

  int sign() const {
    const int a = rational.sign();
    const int b = of_root_2.sign();
    if (a * b >= 0) return a != 0 ? a : b;
    return rational * rational > 2 * of_root_2 * of_root_2 ? a : b;
  }
  friend Number operator-(const Number& x, const Number& y) {
    return {x.rational - y.rational, x.of_root_2 - y.of_root_2};
  }
  friend bool operator<(const Number& x, const Number& y) { return (x - y).sign() < 0; }
  friend bool operator==(const Number& x, const Number& y) { return (x - y).sign() == 0; }
};

/// The least common multiple of the denominators, times a polynomial.
Polynomial whole(const std::vector<Rational>& coefficients) {
  boost::multiprecision::cpp_int common = 1;
  for (const Rational& coefficient : coefficients) common = lcm(common, denominator(coefficient));
  std::vector<Integer> scaled;
  scaled.reserve(coefficients.size());
  for (const Rational& coefficient : coefficients) scaled.emplace_back(numerator(Rational(coefficient * common)));
  return Polynomial(std::move(scaled));
}

/// The polynomial of least degree with this root: its degree is 1 or 2.
Polynomial zero_at(const Number& x) {
  const Rational& a = x.rational;
  if (x.of_root_2 == 0) return whole({-a, 1});
  return whole({a * a - 2 * x.of_root_2 * x.of_root_2, -2 * a, 1});
}

/// (t - middle)^2 + height^2
Polynomial zero_nowhere(const Rational& middle, const Rational& height) {
  return whole({middle * middle + height * height, -2 * middle, 1});
}

Polynomial power(const Polynomial& base, int exponent) {
  Polynomial result({Integer(1)});
  for (int i = 0; i < exponent; ++i) result = result * base;
  return result;
}

int true_sign(const Polynomial& polynomial, const Number& x) {
  Number value = {0};
  for (auto i = polynomial.coefficients().rbegin(); i != polynomial.coefficients().rend(); ++i) {
    const Rational coefficient = static_cast<boost::multiprecision::cpp_int>(*i);
    value = {value.rational * x.rational + 2 * value.of_root_2 * x.of_root_2 + coefficient,
             value.rational * x.of_root_2 + value.of_root_2 * x.rational};
  }
  return value.sign();
}

/// Returns whether `rounded` is nearest to x, which lies between 0 and 1, and even if another number is as near.
bool is_nearest(float rounded, const Number& x) {
  const auto bits = std::bit_cast<std::uint32_t>(rounded);
  const auto midpoint = [](std::uint32_t below) {
    return Number{(Rational(std::bit_cast<float>(below)) + Rational(std::bit_cast<float>(below + 1))) / 2};
  };
  const int below = bits == 0 ? 1 : (x - midpoint(bits - 1)).sign();
  const int above = (midpoint(bits) - x).sign();
  return bits % 2 == 0 ? below >= 0 && above >= 0 : below > 0 && above > 0;
}

struct Root {
  Number at;
  int times = 1;
};

/// Compares all that `UnitRoots` knows with what is true, for the product of these roots' polynomials and `factor`,
/// which has no root between 0 and 1. A root with sqrt(2) brings along its conjugate.
void expect_truth(std::vector<Root> roots, const Polynomial& factor, const std::vector<Polynomial>& others) {
  Polynomial product = factor;
  for (const Root& root : roots) product = product * power(zero_at(root.at), root.times);
  const std::size_t given = roots.size();
  for (std::size_t i = 0; i < given; ++i)
    if (roots[i].at.of_root_2 != 0) roots.push_back({{roots[i].at.rational, -roots[i].at.of_root_2}, roots[i].times});
  std::erase_if(roots, [](const Root& root) { return !(Number{0} < root.at && root.at < Number{1}); });
  std::ranges::sort(roots, [](const Root& a, const Root& b) { return a.at < b.at; });

  const UnitRoots found(product);
  ASSERT_EQ(found.count(), roots.size());
  for (std::size_t i = 0; i < roots.size(); ++i) {
    EXPECT_TRUE(is_nearest(found.rounded(i), roots[i].at)) << i << " " << found.rounded(i);
    EXPECT_EQ(found.multiplicity(i), roots[i].times) << i;
    EXPECT_EQ(found.is_even(i), roots[i].times % 2 == 0) << i;
    EXPECT_EQ(found.sign_at(i, product), 0) << i;
    for (std::size_t other = 0; other < others.size(); ++other)
      EXPECT_EQ(found.sign_at(i, others[other]), true_sign(others[other], roots[i].at)) << i << " " << other;
  }
}

/// What is zero at one or two of the roots, or close beside: of degree up to 4.
std::vector<Polynomial> neighbours(const std::vector<Root>& roots, const Rational& beside) {
  std::vector<Polynomial> others;
  others.reserve(4 * roots.size());
  for (std::size_t i = 0; i < roots.size(); ++i) {
    const Polynomial here = zero_at(roots[i].at);
    others.push_back(here);
    others.push_back(here * zero_at(roots[(i + 1) % roots.size()].at));
    others.push_back(zero_at(roots[i].at - Number{beside}));
    others.push_back(here * zero_at(roots[i].at - Number{-beside}));
  }
  return others;
}

const Polynomial kOne({Integer(1)});

TEST(UnitRoots, KnowHowOftenEachIsARoot) {
  const Number third = {Rational(1, 3)};
  const Number irrational = {Rational(1, 2), Rational(1, 8)};
  for (int times = 1; times <= 6; ++times) {
    SCOPED_TRACE(times);
    expect_truth({{third, times}}, kOne, neighbours({{third}}, to_power_of_two(-300)));
    expect_truth({{third, times}}, power(zero_at(Number{2}), 6 - times), {});
    if (times < 6) expect_truth({{third, times}, {{Rational(2, 3)}, 6 - times}}, kOne, {});
    if (times <= 3) expect_truth({{irrational, times}}, kOne, neighbours({{irrational}}, to_power_of_two(-300)));
  }
  expect_truth({{third, 1}, {{Rational(1, 2)}, 2}, {{Rational(2, 3)}, 3}}, kOne, {});
  expect_truth({{irrational, 2}, {third, 2}}, kOne, neighbours({{irrational}, {third}}, to_power_of_two(-40)));
}

TEST(UnitRoots, LieBetweenTheEndsHoweverOftenTheseAreRoots) {
  for (int at_0 = 0; at_0 <= 4; ++at_0) {
    for (int at_1 = 0; at_0 + at_1 <= 4; ++at_1) {
      const Polynomial ends = power(zero_at(Number{0}), at_0) * power(zero_at(Number{1}), at_1);
      expect_truth({{{to_power_of_two(-200)}}, {{1 - to_power_of_two(-200)}}}, ends, {ends});
      EXPECT_EQ(UnitRoots(ends).count(), 0U);
      EXPECT_EQ(UnitRoots(ends * zero_nowhere(Rational(1, 3), to_power_of_two(-100))).count(), 0U);
    }
  }
}

TEST(UnitRoots, AreToldFromComplexOnesHoweverCloseTheseLie) {
  const Rational middle = Rational(3, 7);
  for (const int exponent : {-10, -40, -300}) {
    SCOPED_TRACE(exponent);
    const Rational height = to_power_of_two(exponent);
    const Polynomial complex = zero_nowhere(middle, height);
    EXPECT_EQ(UnitRoots(complex * complex * zero_nowhere(middle, 2 * height)).count(), 0U);
    expect_truth({{{middle}}}, complex * complex, {complex, zero_at(Number{middle + height})});
    expect_truth({{{middle}, 2}, {{middle + height}}}, complex, {complex, zero_at(Number{middle + height})});
    expect_truth({{{middle, height}}}, complex, neighbours({{{middle, height}}}, height));
  }
}

TEST(UnitRoots, RoundToEvenHalfwayBetweenTwoNumbers) {
  for (const std::uint32_t below : {0U, 1U, 0x3F000000U, 0x3F000001U, 0x3F7FFFFFU}) {
    const Rational at = (Rational(std::bit_cast<float>(below)) + Rational(std::bit_cast<float>(below + 1))) / 2;
    const Rational tiny = to_power_of_two(-400);
    for (int times = 1; times <= 4; ++times) {
      SCOPED_TRACE(times);
      expect_truth({{{at}, times}}, kOne, neighbours({{{at}}}, tiny));
      expect_truth({{{at}, times}, {{at - tiny}}, {{at + tiny}}}, kOne, neighbours({{{at}}, {{at - tiny}}}, tiny));
      expect_truth({{{at}}, {{at + tiny}, times}}, kOne, neighbours({{{at}}, {{at + tiny}}}, 2 * tiny));
    }
  }
}

TEST(UnitRoots, AreToldApartWhereManyRoundAlike) {
  const Rational middle = Rational(3, 7);
  for (const int exponent : {-40, -300}) {
    for (int count = 2; count <= 6; ++count) {
      SCOPED_TRACE(count);
      const Rational step = to_power_of_two(exponent);
      std::vector<Root> even;     // symmetric: where there is a middle root, derivatives vanish there
      std::vector<Root> growing;  // the nearer to the first the closer
      for (int i = 0; i < count; ++i) {
        even.push_back({{middle + i * step}});
        growing.push_back({{middle + to_power_of_two(i * i) * step}});
      }
      for (const std::vector<Root>& roots : {even, growing}) {
        const std::vector<Root> some = {roots.front(), roots[roots.size() / 2], roots.back()};
        expect_truth(roots, kOne, neighbours(some, step / 3));
        if (count < 6) expect_truth(roots, -power(zero_at(Number{2}), 6 - count), neighbours(some, step));
      }
    }
  }
}

TEST(UnitRoots, NeedNoLeadingCoefficients) {
  const UnitRoots roots(Polynomial({Integer(-1), Integer(3), Integer(0), Integer(0), Integer(0), Integer(0)}));
  ASSERT_EQ(roots.count(), 1U);
  EXPECT_EQ(roots.rounded(0), 1.0F / 3);
  EXPECT_EQ(roots.sign_at(0, Polynomial({Integer(-1), Integer(3), Integer(0)})), 0);
  EXPECT_EQ(roots.sign_at(0, Polynomial({Integer(0), Integer(0)})), 0);
  EXPECT_EQ(roots.sign_at(0, Polynomial({Integer(-3), Integer(0)})), -1);
}

/// Draws roots that lie in one place, apart by one small step or by several.
class Draw {
 public:
  explicit Draw(std::uint32_t seed) : engine_(seed) {}

  int up_to(int most) { return std::uniform_int_distribution<int>(0, most)(engine_); }

  void start() {
    middle_ = up_to(3) == 0 ? Rational(up_to(1 << 25), 1 << 25) : Rational(up_to(1000), 1001);
    step_ = to_power_of_two(-std::array{2, 20, 26, 40, 100, 300}[static_cast<std::size_t>(up_to(5))]);
  }

  Rational near() { return middle_ + (up_to(8) - 4) * step_ * (up_to(3) == 0 ? Rational(1, 3) : Rational(1)); }
  Number number() {
    if (up_to(7) == 0) return {Rational(up_to(4) - 1, 3)};
    return {near(), up_to(3) == 0 ? Rational((up_to(4) - 2) * step_) : Rational(0)};
  }
  Polynomial nowhere() { return zero_nowhere(near(), (1 + up_to(2)) * step_); }

  /// Returns roots, none of them twice, of which each conjugate is another too.
  std::vector<Root> roots(int degree) {
    std::vector<Root> roots;
    while (degree > 0 && up_to(9) > 0) {
      const Root root = {number(), 1 + std::max(0, up_to(5) - 3)};
      const int added = root.times * (root.at.of_root_2 == 0 ? 1 : 2);
      const auto known = [&root](const Root& other) {
        return other.at == root.at || other.at == Number{root.at.rational, -root.at.of_root_2};
      };
      if (added > degree || std::ranges::any_of(roots, known)) continue;
      roots.push_back(root);
      degree -= added;
    }
    return roots;
  }

 private:
  std::mt19937 engine_;
  Rational middle_;
  Rational step_;
};

TEST(UnitRoots, AreWhatRandomFactorsSay) {
  Draw draw(1);
  for (int i = 0; i < 300 && !::testing::Test::HasFailure(); ++i) {
    SCOPED_TRACE(i);
    draw.start();
    const Polynomial factor = draw.up_to(2) == 0 ? draw.nowhere() : kOne;
    const std::vector<Root> roots = draw.roots(6 - factor.degree());
    std::vector<Polynomial> others;
    for (int other = 0; other < 6; ++other) {
      others.push_back(Polynomial({Integer(draw.up_to(2) - 1)}));
      while (others.back().degree() < 5 && draw.up_to(4) > 0)
        others.back() = others.back() * (draw.up_to(5) == 0 ? draw.nowhere() : zero_at(draw.number()));
    }
    if (!roots.empty()) others.push_back(zero_at(roots[0].at) * zero_at(draw.number()));
    expect_truth(roots, draw.up_to(1) == 0 ? factor : -factor, others);
  }
}

TEST(Polynomial, KnowsItsSignJustAboveZero) {
  EXPECT_EQ((zero_at(0) * zero_at(1)).sign_after_0(), -1);
  EXPECT_EQ((zero_at(0) * zero_at(0.5) * zero_at(1)).sign_after_0(), 1);
  EXPECT_EQ(Polynomial().sign_after_0(), 0);
}

TEST(Polynomial, KnowsItsSignsJustBesideARoot) {
  const Polynomial twice = zero_at(0.25) * zero_at(0.25);
  EXPECT_EQ(twice.sign_after(0.25), 1);
  EXPECT_EQ(twice.sign_before(0.25), 1);
  EXPECT_EQ((-zero_at(0.25) * twice).sign_after(0.25), -1);
  EXPECT_EQ((-zero_at(0.25) * twice).sign_before(0.25), 1);
  EXPECT_EQ(Polynomial().sign_after(0.25), 0);
}

TEST(Polynomial, HasOneSignWhereItsBernsteinCoefficientsAgree) {
  const Polynomial far = zero_at(-1) * zero_at(2) * zero_at(2) * zero_at(-3) * zero_at(3) * zero_at(-2);
  EXPECT_EQ(far.constant_sign_on(0.25, 0.75), -1);
  EXPECT_EQ((far * zero_at(0.5)).constant_sign_on(0.25, 0.75), 0);
  EXPECT_EQ((far * zero_at(0.75)).constant_sign_on(0.25, 0.75), 0);
  EXPECT_EQ((far * zero_at(0.75)).constant_sign_on(0.25, 0.5), 1);
  EXPECT_EQ(Polynomial().constant_sign_on(0.25, 0.5), 0);
  EXPECT_EQ(Polynomial({Integer(-2)}).constant_sign_on(0.25, 0.5), -1);
  EXPECT_EQ((zero_at(0.25) * zero_at(0.5) * zero_at(0.75)).bernstein_signs(0, 1), (std::vector<int>{-1, 1, -1, 1}));
}

}  // namespace
}  // namespace vestige
