// A point and a triangle that both move: what decide_ccd answers where doubles alone would be wrong.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

#include "detector/decide/ccd_exact.hpp"
#include "detector/decide/ccd_filter.hpp"
#include "detector/decision.hpp"
#include "tests/detector/decide/floor.hpp"

namespace vestige {

void PrintTo(const FirstContact& contact, std::ostream* out) {
  *out << "t " << contact.t << ", side " << int{contact.side};
}

namespace {

using Contact = std::optional<FirstContact>;

using test::kFloor;
using test::moved;

Way scaled(const Way& way, double scale) {
  return {scale * way.start, scale * way.end};
}

Corners scaled(const Corners& triangle, double scale) {
  return {scale * triangle.a, scale * triangle.b, scale * triangle.c};
}

Contact decide(const Way& way, const Corners& before, const Corners& after) {
  return decide_ccd(way, before, after).contact;
}

/// The point rests at the origin, and the volume that it spans with the triangle is (t - p)(t - q)(t - r), up to a
/// power of two: each corner is on the origin's plane at the time it is named for. The last corner comes to the origin
/// itself, at r; with `first_misses` the first two pass beside it.
struct Passes {
  Corners before;
  Corners after;

  Passes(double p, double q, double r, double first_beside, double second_beside)
      : before{{-p, first_beside, first_beside}, {0, -q, second_beside}, {0, 0, -r}},
        after{{1 - p, first_beside, first_beside}, {0, 1 - q, second_beside}, {0, 0, 1 - r}} {}

  Contact contact() const { return decide({}, before, after); }
};

TEST(ContinuousContact, IsWhereBothAreAtThatTime) {
  const Way falls = {{1, 1, 3}, {1, 1, -1}};
  EXPECT_EQ(decide(falls, kFloor, kFloor), (FirstContact{0.75F, 1}));
  EXPECT_EQ(decide(falls, kFloor, moved(kFloor, {0, 0, 2})), (FirstContact{0.5F, 1}));
  EXPECT_EQ(decide(falls, moved(kFloor, {9, 0, 0}), kFloor), std::nullopt) << "the floor comes too late";
  EXPECT_EQ(decide({{1, 1, -1}, {1, 1, -1}}, kFloor, moved(kFloor, {0, 0, -2})), (FirstContact{0.5F, -1}))
      << "a floor that comes down on a resting point";
}

TEST(ContinuousContact, AtTheEndsOfTheFrameCounts) {
  EXPECT_EQ(decide({{1, 1, 1}, {1, 1, 0}}, kFloor, kFloor), (FirstContact{1, 1}));
  EXPECT_EQ(decide({{1, 1, 0}, {1, 1, 1}}, kFloor, kFloor), (FirstContact{0, -1})) << "it comes from below";
  EXPECT_EQ(decide({{1, 1, 0}, {1, 1, -1}}, kFloor, kFloor), (FirstContact{0, 1}));
  EXPECT_EQ(decide({{1, 1, 1}, {1, 1, 0x1p-1074}}, kFloor, kFloor), std::nullopt);
  EXPECT_FALSE(std::signbit(decide({{1, 1, 0}, {1, 1, 1}}, kFloor, kFloor)->t));
}

TEST(ContinuousContact, OnACornerOrAnEdgeIsContactAndOneUlpBesideIsNone) {
  for (const glm::dvec3& spot : {glm::dvec3(0, 0, 0), glm::dvec3(4, 0, 0), glm::dvec3(1.3, 0, 0), glm::dvec3(3, 1, 0)})
    EXPECT_EQ(decide({spot + glm::dvec3(0, 0, 0.7), spot - glm::dvec3(0, 0, 0.7)}, kFloor, kFloor),
              (FirstContact{0.5F, 1}));
  const double beside = std::nextafter(0.0, -1.0);
  EXPECT_EQ(decide({{1, beside, 1}, {1, beside, -1}}, kFloor, kFloor), std::nullopt);
  const double beyond = std::nextafter(3.0, 4.0);
  EXPECT_EQ(decide({{beyond, 1, 1}, {beyond, 1, -1}}, kFloor, kFloor), std::nullopt);
}

/// One coordinate of a, b and a point x = a + (b - a) / 4 exactly between them, whose differences no double equals.
struct OnEdge {
  double a;
  double b;
  double x;

  explicit OnEdge(std::mt19937_64& random) {
    const auto a_units = static_cast<std::int64_t>((random() >> 12U) | (std::uint64_t{1} << 52U));  // of 2^-52
    auto x_units = static_cast<std::int64_t>(random() >> 12U);                                      // of 2^-54
    x_units -= (x_units - 3 * a_units) % 4;
    a = 0x1p-52 * static_cast<double>(a_units);
    b = 0x1p-52 * static_cast<double>(x_units - 3 * a_units);
    x = 0x1p-54 * static_cast<double>(x_units);
  }
};

TEST(ContinuousContact, OnAnEdgeIsContactEvenWhereItsDifferencesAreRounded) {
  std::mt19937_64 random(4);
  for (int i = 0; i < 200; ++i) {
    const OnEdge along_x(random);
    const OnEdge along_y(random);
    const Corners triangle = {{along_x.a, along_y.a, 0}, {along_x.b, along_y.b, 0}, {5, -7, 0}};
    const Way way = {{along_x.x, along_y.x, 1}, {along_x.x, along_y.x, -1}};
    const Contact contact = decide(way, triangle, triangle);
    ASSERT_TRUE(contact.has_value()) << i;
    EXPECT_EQ(contact->t, 0.5F);
  }
}

TEST(ContinuousContact, IsTheFirstOfThreePasses) {
  EXPECT_EQ(Passes(0.25, 0.5, 0.75, 0, 0).contact(), (FirstContact{0.25F, 1}));
  EXPECT_EQ(Passes(0.25, 0.5, 0.75, -1, 0).contact(), (FirstContact{0.5F, -1})) << "the first passes beside";
  EXPECT_EQ(Passes(0.25, 0.5, 0.75, -1, -1).contact(), (FirstContact{0.75F, 1})) << "so does the second";
}

TEST(ContinuousContact, PassesWithinOneFloatOfEachOtherAreToldApart) {
  const double near = 0.5 + 0x1p-40;
  const double next = 0.5 + 0x1p-39;
  EXPECT_EQ(Passes(0.5, near, next, 0, 0).contact(), (FirstContact{0.5F, 1}));
  EXPECT_EQ(Passes(0.5, near, next, -1, 0).contact(), (FirstContact{0.5F, -1}));
  EXPECT_EQ(Passes(0.5, near, next, -1, -1).contact(), (FirstContact{0.5F, 1}));
  EXPECT_EQ(Passes(0.125, near, next, -1, -1).contact(), (FirstContact{0.5F, 1}));
  EXPECT_EQ(Passes(0.5, near, 0.875, -1, -1).contact(), (FirstContact{0.875F, 1}));
  EXPECT_EQ(Passes(0.5, near, 2, -1, -1).contact(), std::nullopt);
}

TEST(ContinuousContact, ATouchThatTurnsBackIsContactFromTheSideItCameFrom) {
  EXPECT_EQ(Passes(0.5, 0.5, 0.75, 0, 0).contact(), (FirstContact{0.5F, 1}));
  EXPECT_EQ(Passes(0.5, 0.5, 0.75, -1, -1).contact(), (FirstContact{0.75F, 1})) << "the touch is beside";
  EXPECT_EQ(Passes(0.3, 0.3, 0.3, 0, 0).contact(), (FirstContact{0.3F, 1}));
  EXPECT_EQ(Passes(0.3, 0.3, 0.3, -1, -1).contact(), (FirstContact{0.3F, 1}));
  EXPECT_EQ(Passes(0.25, 0.5, 0.5, -1, 0).contact(), (FirstContact{0.5F, -1}));
}

TEST(ContinuousContact, TimeIsRoundedToNearestAndHalfwayToEven) {
  const double step = 0x1p-24;  // between neighbours from 0.5 to 1
  for (const double odd : {0.5 + step, 0.5 + 2 * step}) {
    const double halfway = odd + 0.5 * step;
    const double even = odd == 0.5 + step ? odd + step : odd;
    const auto time_of = [](double t) {
      return decide({{1, 1, t}, {1, 1, t - 1}}, kFloor, kFloor).value_or(FirstContact{}).t;
    };
    EXPECT_EQ(time_of(halfway), even);
    EXPECT_EQ(time_of(std::nextafter(halfway, 0.0)), odd);
    EXPECT_EQ(time_of(std::nextafter(halfway, 1.0)), odd + step);
  }
}

TEST(ContinuousContact, TooEarlyForAFloatIsAtZero) {
  const auto contact = decide({{1, 1, 0x1p-160}, {1, 1, -1}}, kFloor, kFloor);
  EXPECT_EQ(contact, (FirstContact{0, 1}));
}

TEST(ContinuousContact, WithinAPlaneIsWhenThePointCrossesAnEdge) {
  EXPECT_EQ(decide({{-1, 1, 0}, {1, 1, 0}}, kFloor, kFloor), (FirstContact{0.5F, 0}));
  EXPECT_EQ(decide({{1, 1, 0}, {9, 9, 0}}, kFloor, kFloor), (FirstContact{0, 0})) << "inside from the start";
  EXPECT_EQ(decide({{-1, 4, 0}, {1, 4, 0}}, kFloor, kFloor), (FirstContact{0.5F, 0})) << "over a corner";
  EXPECT_EQ(decide({{-1, 5, 0}, {1, 5, 0}}, kFloor, kFloor), std::nullopt);
  EXPECT_EQ(decide({{-1, 0, 0}, {1, 0, 0}}, kFloor, kFloor), (FirstContact{0.5F, 0})) << "along an edge";
  EXPECT_EQ(decide({{-1, 1, 0}, {-1, 1, 0}}, moved(kFloor, {1, 0, 0}), moved(kFloor, {-3, 0, 0})),
            (FirstContact{0.5F, 0}))
      << "the triangle slides over the point";
}

TEST(ContinuousContact, WithinAPlaneThatTurnsIsFoundToo) {
  // Everything stays in z = t x.
  const Corners turned = {{0, 0, 0}, {4, 0, 4}, {0, 4, 0}};
  EXPECT_EQ(decide({{1, -1, 0}, {1, 1, 1}}, kFloor, turned), (FirstContact{0.5F, 0}));
  EXPECT_EQ(decide({{1, -3, 0}, {1, -1, 1}}, kFloor, turned), std::nullopt);
}

TEST(ContinuousContact, KnowsTrianglesWithoutArea) {
  const Corners needle = {{0, 0, 0}, {2, 0, 0}, {4, 0, 0}};
  const Corners dot = {{1, 1, 1}, {1, 1, 1}, {1, 1, 1}};
  EXPECT_EQ(decide({{1, 0, 1}, {1, 0, -1}}, needle, needle), (FirstContact{0.5F, 0}));
  EXPECT_EQ(decide({{5, 0, 1}, {5, 0, -1}}, needle, needle), std::nullopt);
  EXPECT_EQ(decide({{5, 0, 0}, {3, 0, 0}}, needle, needle), (FirstContact{0.5F, 0})) << "along it";
  EXPECT_EQ(decide({{0, 0, 0}, {2, 2, 2}}, dot, dot), (FirstContact{0.5F, 0}));
  EXPECT_EQ(decide({{1, 1, 1}, {1, 1, 1}}, dot, dot), (FirstContact{0, 0})) << "nothing moves";
  EXPECT_EQ(decide({{1, 1, 2}, {1, 1, 2}}, dot, dot), std::nullopt);
  EXPECT_EQ(decide({}, {}, {}), (FirstContact{0, 0}));
}

TEST(ContinuousContact, KnowsATriangleThatCollapsesAtTheMomentOfContact) {
  // The third corner crosses the line of the others when the point is on it: between them, beside them.
  const Corners before = {{-1, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const Corners after = {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}};
  EXPECT_EQ(decide({{0.5, 0, 1}, {0.5, 0, -1}}, before, after), (FirstContact{0.5F, 1}));
  EXPECT_EQ(decide({{1.5, 0, 1}, {1.5, 0, -1}}, before, after), std::nullopt);
}

TEST(ContinuousContact, DoesNotDependOnTheUnit) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  const auto point = [&] { return glm::dvec3(coordinate(random), coordinate(random), coordinate(random)); };
  int contacts = 0;
  for (int i = 0; i < 300; ++i) {
    const Way way = {point(), point()};
    const Corners before = {point(), point(), point()};
    const Corners after = {point(), point(), point()};
    const Contact expected = decide(way, before, after);
    contacts += expected.has_value();
    for (const double unit : {0x1p-950, 0x1p-352, 0x1p-300, 0x1p300, 0x1p1022})
      EXPECT_EQ(decide(scaled(way, unit), scaled(before, unit), scaled(after, unit)), expected) << unit;
  }
  EXPECT_GT(contacts, 10);
}

TEST(ContinuousContact, IsRightForTheLeastAndTheGreatestNumbers) {
  const double least = std::numeric_limits<double>::denorm_min();
  const double greatest = std::numeric_limits<double>::max();
  const Corners tiny = {{0, 0, 0}, {4 * least, 0, 0}, {0, 4 * least, 0}};
  EXPECT_EQ(decide({{least, least, least}, {least, least, -least}}, tiny, tiny), (FirstContact{0.5F, 1}));
  EXPECT_EQ(decide({{least, -least, least}, {least, -least, -least}}, tiny, tiny), std::nullopt);
  const Corners huge = {{-greatest, -greatest, 0}, {greatest, -greatest, 0}, {0, greatest, 0}};
  EXPECT_EQ(decide({{0, 0, greatest}, {0, 0, -greatest}}, huge, huge), (FirstContact{0.5F, 1}));
  EXPECT_EQ(decide({{0, 0, least}, {0, 0, -least}}, huge, huge), (FirstContact{0.5F, 1}));
}

TEST(ContinuousContact, WithAnOrdinaryTriangleNeedsNoExactArithmetic) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  const auto point = [&] { return glm::dvec3(coordinate(random), coordinate(random), coordinate(random)); };
  int exact = 0;
  for (int i = 0; i < 20000; ++i)
    exact += decide_ccd({point(), point()}, {point(), point(), point()}, {point(), point(), point()}).exact_arithmetic;
  EXPECT_LE(exact, 2);
}

TEST(ContinuousContact, WhatDoublesProveIsWhatWholeNumbersSay) {
  // On a coarse grid nearly every pair touches a corner, an edge or a plane.
  std::mt19937 random(3);
  int proofs = 0;
  for (const int cells : {2, 4, 1000}) {
    std::uniform_int_distribution<int> coordinate(-cells, cells);
    const auto point = [&] { return glm::dvec3(coordinate(random), coordinate(random), coordinate(random)); };
    for (int i = 0; i < 4000; ++i) {
      const Way way = {point(), point()};
      const Corners before = {point(), point(), point()};
      const Corners after = {point(), point(), point()};
      const CcdProof proof = filter_ccd(way, before, after);
      if (proof.verdict == CcdProof::Verdict::kUnsure) continue;
      ++proofs;
      const Contact proven = proof.verdict == CcdProof::Verdict::kContact ? Contact(proof.contact) : std::nullopt;
      EXPECT_EQ(proven, ccd_in_integers(way, before, after));
    }
  }
  EXPECT_GT(proofs, 6000);
}

TEST(ContinuousContact, IsFoundWhereProductsOfDoublesVanish) {
  // Both touch at the very end, and products of three such coordinates are rounded to whole steps of 2^-1074: doubles
  // alone would prove that they never meet.
  struct Case {
    Way way;
    Corners before;
    Corners after;
  };
  const std::array cases = {
      Case{{{6, -3, 2}, {1, -4, -1}}, {{5, 4, 6}, {-5, 4, 5}, {7, -5, 1}}, {{6, 8, -3}, {-2, -3, -8}, {2, -5, 2}}},
      Case{{{0, 4, -4}, {3, -2, 0}}, {{7, -4, 4}, {2, -6, -1}, {3, 7, -7}}, {{7, 8, 4}, {0, -4, 7}, {1, -7, -2}}}};
  for (const Case& each : cases)
    for (const double unit : {1.0, 0x1p-359})
      EXPECT_EQ(decide(scaled(each.way, unit), scaled(each.before, unit), scaled(each.after, unit)),
                (FirstContact{1, -1}))
          << unit;
}

}  // namespace
}  // namespace vestige
