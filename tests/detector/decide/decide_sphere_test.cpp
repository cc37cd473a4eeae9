// A sphere and a triangle: what decide_sphere answers, beside the independent truth.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <random>

#include "detector/decide/sphere_exact.hpp"
#include "detector/decide/sphere_filter.hpp"
#include "detector/decide/start_distance.hpp"
#include "detector/decide/triangle_distance.hpp"
#include "detector/decision.hpp"
#include "detector/truth/truth.hpp"
#include "tests/detector/decide/floor.hpp"

namespace vestige {

void PrintTo(const FirstTouch& touch, std::ostream* out) {
  *out << "t " << touch.t << ", side " << int{touch.side} << (touch.at_start ? ", at the start" : "");
}

namespace {

using Touch = std::optional<FirstTouch>;

using test::kFloor;
using test::moved;

/// Expects the deciding code, its exact part and the truth to agree, and returns their answer.
Touch decide(const MovingSphere& sphere, const Corners& before, const Corners& after) {
  const Touch touch = decide_sphere(sphere, before, after).touch;
  EXPECT_EQ(touch, sphere_in_integers(sphere, before, after));
  EXPECT_EQ(touch, exact::sphere_contact(sphere, before, after));
  return touch;
}

Touch decide(const MovingSphere& sphere, const Corners& triangle) {
  return decide(sphere, triangle, triangle);
}

TEST(Sphere, ThatFallsOntoAFaceTouchesWhenItsCentreIsARadiusAway) {
  EXPECT_EQ(decide({{{1, 1, 3}, {1, 1, -1}}, 1}, kFloor), (FirstTouch{0.5F, 1, false}));
  EXPECT_EQ(decide({{{1, 1, -3}, {1, 1, 1}}, 1}, kFloor), (FirstTouch{0.5F, -1, false}));
  EXPECT_EQ(decide({{{1, 1, 3}, {1, 1, 2}}, 1}, kFloor), std::nullopt);
  EXPECT_EQ(decide({{{1, 1, 3}, {1, 1, 1}}, 1}, kFloor), (FirstTouch{1, 1, false})) << "just at the end";
}

TEST(Sphere, ThatComesFromTheSideTouchesTheEdgeOrTheCorner) {
  EXPECT_EQ(decide({{{1, -3, 0}, {1, 1, 0}}, 1}, kFloor), (FirstTouch{0.5F, 0, false})) << "an edge, in the plane";
  EXPECT_EQ(decide({{{-3, 0, 0}, {1, 0, 0}}, 1}, kFloor), (FirstTouch{0.5F, 0, false})) << "a corner";
  const Touch over_edge = decide({{{1, -3, 0.6}, {1, 1, 0.6}}, 1}, kFloor);
  ASSERT_TRUE(over_edge);
  EXPECT_EQ(over_edge->side, 1);
  EXPECT_NEAR(over_edge->t, (3 - 0.8) / 4, 1e-6);
}

TEST(Sphere, ThatRestsTouchesAtTheStartOfEveryFrame) {
  EXPECT_EQ(decide({{{1, 1, 1}, {1, 1, 1}}, 1}, kFloor), (FirstTouch{0, 1, true})) << "exactly at the radius";
  EXPECT_EQ(decide({{{1, 1, 0.5}, {1, 1, 0.5}}, 1}, kFloor), (FirstTouch{0, 1, true}));
  EXPECT_EQ(decide({{{1, 1, -0.5}, {1, 1, 2.5}}, 1}, kFloor), (FirstTouch{0, -1, true})) << "it leaves";
  EXPECT_EQ(decide({{{1, 1, 0}, {1, 1, 5}}, 1}, kFloor), (FirstTouch{0, -1, true})) << "its centre is on the skin";
  EXPECT_EQ(decide({{{1, 1, 1.0000001}, {1, 1, 1.0000001}}, 1}, kFloor), std::nullopt);
}

TEST(Sphere, WhollyInsideABodyTouchesNothing) {
  EXPECT_EQ(decide({{{1, 1, -2}, {2, 1, -2}}, 1}, kFloor), std::nullopt);
}

TEST(Sphere, ThatGrazesTouchesOnceExactly) {
  EXPECT_EQ(decide({{{-3, 1, 1}, {5, 1, 1}}, 1}, kFloor), (FirstTouch{0.375F, 1, false})) << "it rolls over the face";
  EXPECT_EQ(decide({{{-2, -1, 0}, {6, -1, 0}}, 1}, kFloor), (FirstTouch{0.25F, 0, false})) << "along an edge";
  EXPECT_EQ(decide({{{-1, -2, 0}, {-1, 2, 0}}, 1}, kFloor), (FirstTouch{0.5F, 0, false})) << "past a corner";
  EXPECT_EQ(decide({{{-3, -1.5, 1}, {5, -1.5, 1}}, 1}, kFloor), std::nullopt);
}

TEST(Sphere, MeetsATriangleThatMovesWhereBothAreAtThatTime) {
  EXPECT_EQ(decide({{{1, 1, 3}, {1, 1, 3}}, 1}, kFloor, moved(kFloor, {0, 0, 4})), (FirstTouch{0.5F, 1, false}));
  EXPECT_EQ(decide({{{1, 1, 3}, {1, 1, 7}}, 1}, kFloor, moved(kFloor, {0, 0, 4})), std::nullopt) << "both move alike";
}

TEST(Sphere, TouchesATriangleThatHasNoAreaAndOneThatCollapses) {
  const Corners needle = {{0, 0, 0}, {4, 0, 0}, {2, 0, 0}};
  EXPECT_EQ(decide({{{1, -3, 0}, {1, 1, 0}}, 1}, needle), (FirstTouch{0.5F, 0, false}));
  const Corners point = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
  EXPECT_EQ(decide({{{0, -3, 0}, {0, 1, 0}}, 1}, point), (FirstTouch{0.5F, 0, false}));
  // The floor shrinks to its first corner and grows out on the other side, away from the sphere that waits there.
  const Corners turned = {{0, 0, 0}, {-4, 0, 0}, {0, -4, 0}};
  EXPECT_EQ(decide({{{-2, -2, 0.5}, {-2, -2, 0.5}}, 0.75}, kFloor, turned).has_value(), true);
  EXPECT_EQ(decide({{{2, -2, 0}, {2, -2, 0}}, 0.5}, kFloor, turned), std::nullopt);
}

TEST(Sphere, OfAnySizeIsDecidedExactly) {
  for (const double scale : {0x1p-149, 0x1p-60, 0x1p-20, 1.0, 0x1p20, 0x1p60, 0x1p125}) {
    const auto at = [scale](double x, double y, double z) { return scale * glm::dvec3(x, y, z); };
    const Corners floor = {at(0, 0, 0), at(4, 0, 0), at(0, 4, 0)};
    EXPECT_EQ(decide({{at(1, 1, 3), at(1, 1, -1)}, scale}, floor), (FirstTouch{0.5F, 1, false})) << scale;
    EXPECT_EQ(decide({{at(1, 1, 1), at(1, 1, 1)}, scale}, floor), (FirstTouch{0, 1, true})) << scale;
  }
  EXPECT_EQ(decide({{{1, 1, 3}, {1, 1, -1}}, 0x1p-149}, kFloor)->t, 0.75F) << "a denormal radius";
  EXPECT_EQ(decide({{{1, 1, 900}, {1, 1, 800}}, 850}, kFloor)->t, 0.5F) << "larger than the body";
}

/// A few whole numbers, so that every degeneracy is frequent.
class SmallNumbers {
 public:
  explicit SmallNumbers(std::uint32_t seed) : random_(seed) {}
  glm::dvec3 point() { return {number(), number(), number()}; }
  Corners triangle() { return {point(), point(), point()}; }
  double radius() { return std::array{0.5, 1.0, 1.5, 2.0, 3.0, 0x1p-149}[random_() % 6]; }

 private:
  double number() { return static_cast<double>(random_() % 5) - 2; }
  std::mt19937 random_;
};

TEST(Sphere, AgreesWithTheTruthAmongSmallNumbers) {
  SmallNumbers numbers(1);
  int touches = 0;
  for (int i = 0; i < 3000 && !::testing::Test::HasFailure(); ++i) {
    const MovingSphere sphere = {{numbers.point(), numbers.point()}, numbers.radius()};
    const Touch touch = decide(sphere, numbers.triangle());
    if (touch && !touch->at_start) ++touches;
  }
  EXPECT_GT(touches, 300);
}

TEST(Sphere, AgreesWithTheTruthAmongSmallNumbersIfAllMoves) {
  SmallNumbers numbers(2);
  int touches = 0;
  for (int i = 0; i < 1500 && !::testing::Test::HasFailure(); ++i) {
    const MovingSphere sphere = {{numbers.point(), numbers.point()}, numbers.radius()};
    const Touch touch = decide(sphere, numbers.triangle(), numbers.triangle());
    if (touch && !touch->at_start) ++touches;
  }
  EXPECT_GT(touches, 150);
}

TEST(Sphere, IsNearlyAlwaysDecidedWithoutExactArithmetic) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> place(-1, 1);
  const auto point = [&] { return glm::dvec3(place(random), place(random), place(random)); };
  int exact = 0;
  int touches = 0;
  constexpr int kPairs = 20000;
  for (int i = 0; i < kPairs; ++i) {
    const MovingSphere sphere = {{point(), point()}, 0.1F};
    const SphereDecision decision = decide_sphere(sphere, {point(), point(), point()}, {point(), point(), point()});
    exact += decision.exact_arithmetic ? 1 : 0;
    touches += decision.touch ? 1 : 0;
  }
  EXPECT_GT(touches, kPairs / 20);
  EXPECT_LT(exact, kPairs / 100);
}

TEST(TriangleDistance, ContainsTheExactDistance) {
  SmallNumbers numbers(4);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> part(-1e-7, 1e-7);
  for (int i = 0; i < 3000; ++i) {
    Corners triangle = numbers.triangle();
    if (i % 2 == 0) triangle.c += glm::dvec3(part(random), part(random), part(random));
    const double reach = reach_of(triangle);
    if (!is_in_range(reach)) continue;
    const DistanceRange range = separation_from(triangle, reach).range;
    EXPECT_GE(exact::compare_distance({glm::dvec3(0), triangle}, range.low), 0) << i;
    EXPECT_LE(exact::compare_distance({glm::dvec3(0), triangle}, range.high), 0) << i;
    EXPECT_LT(range.high - range.low, i % 2 == 0 ? 1e-6 : 1e-13) << i;
  }
}

TEST(StartDistance, ComparesExactly) {
  SmallNumbers numbers(6);
  int equal = 0;
  for (int i = 0; i < 3000; ++i) {
    const glm::dvec3 centre = numbers.point();
    const Corners first = numbers.triangle();
    const Corners second = numbers.triangle();
    bool unused = false;
    const int order = StartDistance::compare({centre, first}, {centre, second}, unused);
    EXPECT_EQ(order, exact::compare_distances({centre, first}, {centre, second})) << i;
    if (order == 0) ++equal;
    const double radius = numbers.radius();
    EXPECT_EQ(StartDistance::compare({centre, first}, radius, unused),
              exact::compare_distance({centre, first}, radius));
  }
  EXPECT_GT(equal, 20);
}

TEST(StartDistance, OfTrianglesThatShareTheNearestPartNeedsNoExactArithmetic) {
  const glm::dvec3 ridge(0.1F, 0.7F, 0.3F);
  const glm::dvec3 top(0.9F, 0.8F, 0.35F);
  const glm::dvec3 centre(0.5F, 0.75F, 0.9F);
  const Corners left = {ridge, top, {0.4F, 0.1F, -0.8F}};
  const Corners right = {top, ridge, {0.45F, 1.4F, -0.7F}};
  bool exact_arithmetic = false;
  EXPECT_EQ(StartDistance::compare({centre, left}, {centre, right}, exact_arithmetic), 0);
  EXPECT_FALSE(exact_arithmetic) << "a shared edge";
  const glm::dvec3 above(0.0F, 0.6F, 0.9F);
  EXPECT_EQ(StartDistance::compare({above, left}, {above, right}, exact_arithmetic), 0);
  EXPECT_FALSE(exact_arithmetic) << "a shared corner";
}

}  // namespace
}  // namespace vestige
