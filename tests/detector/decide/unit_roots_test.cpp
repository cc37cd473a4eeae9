// Roots that are asked, not approximated.

#include "detector/decide/unit_roots.hpp"

#include <gtest/gtest.h>

#include <array>

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

TEST(Polynomial, KnowsItsSignJustAboveZero) {
  EXPECT_EQ((zero_at(0) * zero_at(1)).sign_after_0(), -1);
  EXPECT_EQ((zero_at(0) * zero_at(0.5) * zero_at(1)).sign_after_0(), 1);
  EXPECT_EQ(Polynomial().sign_after_0(), 0);
}

}  // namespace
}  // namespace vestige
