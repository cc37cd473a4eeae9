// Why the slow truth may be called that: it is right where the answer is known, and keeps every symmetry that the
// question has, on hard cases of every kind.

#include "detector/truth/truth.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "analysis/stress/query_file.hpp"
#include "tests/support/pairs/contact_cases.hpp"
#include "tests/support/test_data.hpp"

namespace vestige {
namespace {

using exact::ccd_contact;
using exact::static_contact;
using test::ContactCase;

const Corners kTriangle = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

Corners shifted(const Corners& triangle, const glm::dvec3& by) {
  return {triangle.a + by, triangle.b + by, triangle.c + by};
}

TEST(StaticTruth, KnowsWhenAndFromWhichSide) {
  EXPECT_EQ(static_contact({{0.25, 0.25, 1}, {0.25, 0.25, -3}}, kTriangle), (FirstContact{0.25F, 1}));
  EXPECT_EQ(static_contact({{0.25, 0.25, -1}, {0.25, 0.25, 2}}, kTriangle), (FirstContact{1.0F / 3, -1}));
  EXPECT_EQ(static_contact({{0.25, 0.25, 0}, {0.25, 0.25, 2}}, kTriangle), (FirstContact{0, -1}));
  EXPECT_EQ(static_contact({{-1, 0.25, 0}, {1, 0.25, 0}}, kTriangle), (FirstContact{0.5F, 0}));
  EXPECT_EQ(static_contact({{0.25, 0.25, 0}, {0.25, 0.25, 0}}, kTriangle), (FirstContact{0, 0}));
  EXPECT_FALSE(static_contact({{0.25, 0.25, 1}, {0.25, 0.25, 1e-300}}, kTriangle));
  EXPECT_FALSE(static_contact({{-1e-300, 0.5, 1}, {-1e-300, 0.5, -1}}, kTriangle));
}

TEST(StaticTruth, RoundsTimesToNearestEvenDenormalsIncluded) {
  const auto time_when_falling_from = [](double z) {
    return static_contact({{0.25, 0.25, z}, {0.25, 0.25, z - 1}}, kTriangle)->t;
  };
  EXPECT_EQ(time_when_falling_from(0.5 + 0x1p-25), 0.5F);  // halfway, to even
  EXPECT_EQ(time_when_falling_from(0.5 + 0x1p-25 + 0x1p-50), 0.5F + 0x1p-24F);
  EXPECT_EQ(time_when_falling_from(0.5 + 3 * 0x1p-25), 0.5F + 0x1p-23F);  // halfway, to even
  // Through the plane z = 0 at 2^-149 and at half of that of the way, and just beyond.
  const auto after = [](double part) { return static_contact({{0.25, 0.25, part}, {0.25, 0.25, -1}}, kTriangle)->t; };
  EXPECT_EQ(after(0x1p-149), 0x1p-149F);
  EXPECT_EQ(after(0x1p-150), 0.0F);
  EXPECT_EQ(after(0x1.8p-150), 0x1p-149F);
  EXPECT_FALSE(std::signbit(after(0x1p-1000)));
}

TEST(ContinuousTruth, KnowsWhenAndFromWhichSide) {
  const glm::dvec3 up(0, 0, 1);
  EXPECT_EQ(ccd_contact({{0.25, 0.25, 0.5}, {0.25, 0.25, 0.5}}, kTriangle, shifted(kTriangle, up)),
            (FirstContact{0.5F, 1}));
  EXPECT_EQ(ccd_contact({{0.25, 0.25, 0}, {0.25, 0.25, 0}}, kTriangle, shifted(kTriangle, up)),
            (FirstContact{0, 1}));  // it is behind just afterwards
  EXPECT_FALSE(ccd_contact({{0.25, 0.25, 1}, {0.25, 0.25, 1.5}}, kTriangle, shifted(kTriangle, up)));
}

TEST(ContinuousTruth, SolvesForTimesThatNoFractionEquals) {
  // b = (1, 0, t), x = (t, 0.25, 0.5): the height is 0.5 - t * t.
  const Corners before = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const Corners after = {{0, 0, 0}, {1, 0, 1}, {0, 1, 0}};
  const auto contact = ccd_contact({{0, 0.25, 0.5}, {1, 0.25, 0.5}}, before, after);
  ASSERT_TRUE(contact);
  EXPECT_EQ(contact->t, static_cast<float>(std::sqrt(0.5)));
  EXPECT_EQ(contact->side, 1);
}

TEST(ContinuousTruth, FindsATouchThatTurnsBack) {
  // b = (1, 0, 3 t - 1), x = (1 - 3 t, 0.25, 0): the height is (3 t - 1)^2.
  const Corners before = {{0, 0, 0}, {1, 0, -1}, {0, 1, 0}};
  const Corners after = {{0, 0, 0}, {1, 0, 2}, {0, 1, 0}};
  EXPECT_EQ(ccd_contact({{1, 0.25, 0}, {-2, 0.25, 0}}, before, after), (FirstContact{1.0F / 3, 1}));
}

TEST(ContinuousTruth, SolvesMotionThatStaysInOnePlane) {
  EXPECT_EQ(ccd_contact({{2, 0.25, 0}, {2, 0.25, 0}}, kTriangle, shifted(kTriangle, {5, 0, 0})),
            (FirstContact{0.25F, 0}));  // its slanted side comes with x + y = 1 at x = 0.75
  EXPECT_FALSE(ccd_contact({{2, 1.25, 0}, {2, 1.25, 0}}, kTriangle, shifted(kTriangle, {5, 0, 0})));
}

TEST(ContinuousTruth, KnowsATriangleThatIsALineJustThen) {
  // c passes from one side of ab to the other through its middle, when x is on the line.
  const Corners before = {{0, 0, 0}, {2, 0, 0}, {1, -1, 1}};
  const Corners after = {{0, 0, 0}, {2, 0, 0}, {1, 1, -1}};
  EXPECT_EQ(ccd_contact({{0.5, 0, 1}, {0.5, 0, -1}}, before, after)->t, 0.5F);
  EXPECT_FALSE(ccd_contact({{2.5, 0, 1}, {2.5, 0, -1}}, before, after));
}

class EveryKind : public ::testing::TestWithParam<std::string_view> {
 protected:
  /// Calls `check` with cases, and expects that some are contacts.
  template <typename Check>
  void each_case(const Check& check) const {
    const int cases = GetParam() == "extreme" ? 100 : 1000;
    test::CaseGenerator generator(GetParam(), 2);
    int contacts = 0;
    for (int i = 0; i < cases; ++i) {
      const ContactCase c = generator.next();
      const auto contact = ccd_contact(c.way, c.before, c.after);
      if (contact) ++contacts;
      check(c, contact);
    }
    EXPECT_GT(contacts, cases / 40);
  }
};

TEST_P(EveryKind, OfTriangleMayBeginAtAnyCornerAndTurnedRoundHasTheOtherSide) {
  each_case([](const ContactCase& c, const std::optional<FirstContact>& contact) {
    const auto next = [](const Corners& x) { return Corners{x.b, x.c, x.a}; };
    const auto turned = [](const Corners& x) { return Corners{x.b, x.a, x.c}; };
    EXPECT_EQ(ccd_contact(c.way, next(c.before), next(c.after)), contact);
    EXPECT_EQ(static_contact(c.way, next(c.after)), static_contact(c.way, c.after));
    const auto back = ccd_contact(c.way, turned(c.before), turned(c.after));
    ASSERT_EQ(back.has_value(), contact.has_value());
    if (!contact) return;
    EXPECT_EQ(back->t, contact->t);
    EXPECT_EQ(back->side, -contact->side);
  });
}

TEST_P(EveryKind, OfMotionMeetsBackwardsWhatItMeetsForwards) {
  each_case([](const ContactCase& c, const std::optional<FirstContact>& contact) {
    const auto back = ccd_contact({c.way.end, c.way.start}, c.after, c.before);
    ASSERT_EQ(back.has_value(), contact.has_value());
    if (!contact) return;
    EXPECT_GE(1 - static_cast<double>(back->t) + 0x1p-24, static_cast<double>(contact->t));
  });
}

TEST_P(EveryKind, OfTriangleAtRestIsTheSameForBothMethods) {
  each_case([](const ContactCase& c, const std::optional<FirstContact>&) {
    EXPECT_EQ(ccd_contact(c.way, c.after, c.after), static_contact(c.way, c.after));
  });
}

TEST_P(EveryKind, OfSceneMayHaveItsAxesExchanged) {
  each_case([](const ContactCase& c, const std::optional<FirstContact>& contact) {
    const auto point = [](const glm::dvec3& x) { return glm::dvec3(x.y, x.z, x.x); };
    const auto corners = [&point](const Corners& x) { return Corners{point(x.a), point(x.b), point(x.c)}; };
    const Way way = {point(c.way.start), point(c.way.end)};
    EXPECT_EQ(ccd_contact(way, corners(c.before), corners(c.after)), contact);
    EXPECT_EQ(static_contact(way, corners(c.after)), static_contact(c.way, c.after));
  });
}

INSTANTIATE_TEST_SUITE_P(Families, EveryKind, ::testing::ValuesIn(test::case_families()),
                         [](const auto& test) { return std::string(test.param); });

class WholeNumbers : public ::testing::TestWithParam<std::string_view> {};

/// On whole numbers a motion added to all, and the middle of a motion, are exact.
TEST_P(WholeNumbers, MaySeeTheSceneFromWhateverMoves) {
  test::CaseGenerator generator(GetParam(), 3);
  const glm::dvec3 at_0(3, -5, 7);
  const glm::dvec3 at_1(-11, 2, 1);
  for (int i = 0; i < 2000; ++i) {
    const ContactCase c = generator.next();
    EXPECT_EQ(ccd_contact({c.way.start + at_0, c.way.end + at_1}, shifted(c.before, at_0), shifted(c.after, at_1)),
              ccd_contact(c.way, c.before, c.after));
  }
}

TEST_P(WholeNumbers, FindInHalvesOfAFrameWhatTheyFindInTheWhole) {
  test::CaseGenerator generator(GetParam(), 4);
  const auto half = [](const glm::dvec3& x, const glm::dvec3& y) { return 0.5 * (x + y); };
  for (int i = 0; i < 2000; ++i) {
    const ContactCase c = generator.next();
    const glm::dvec3 middle = half(c.way.start, c.way.end);
    const Corners between = {half(c.before.a, c.after.a), half(c.before.b, c.after.b), half(c.before.c, c.after.c)};
    const auto first = ccd_contact({c.way.start, middle}, c.before, between);
    const auto second = ccd_contact({middle, c.way.end}, between, c.after);
    const auto all = ccd_contact(c.way, c.before, c.after);
    ASSERT_EQ(all.has_value(), first.has_value() || second.has_value());
    if (first) {
      EXPECT_EQ(all->t, 0.5F * first->t);
    } else if (second) {
      EXPECT_NEAR(all->t, 0.5 + 0.5 * static_cast<double>(second->t), 0x1p-24);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Families, WholeNumbers, ::testing::Values("integer", "collapse", "coplanar"),
                         [](const auto& test) { return std::string(test.param); });

TEST(PublicQueries, AreAllAnsweredRightlyByTheTruth) {
  const auto folder = test::data("ccd");
  VESTIGE_REQUIRE_DATA(folder);
  std::size_t queries = 0;
  std::size_t wrong = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.path().extension() != ".csv") continue;
    const QueryFile file = read_query_file(entry.path(), Inexact::kRefuse);
    for (const Query& query : file.queries) {
      const auto contact = file.kind == QueryKind::kSegmentTriangle ? static_contact(query.way, query.after)
                                                                    : ccd_contact(query.way, query.before, query.after);
      if (contact.has_value() != query.truth) ++wrong;
      ++queries;
    }
  }
  EXPECT_EQ(queries, 3028U);
  EXPECT_EQ(wrong, 0U);
}

}  // namespace
}  // namespace vestige
