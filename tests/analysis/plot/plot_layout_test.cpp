#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "analysis/plot/canvas/axis.hpp"
#include "analysis/plot/canvas/free_place.hpp"

namespace vestige::plot {
namespace {

using ::testing::DoubleEq;
using ::testing::ElementsAre;

std::vector<std::string> labels(const std::vector<Tick>& ticks) {
  std::vector<std::string> result;
  for (const Tick& tick : ticks)
    if (!tick.label.empty()) result.push_back(tick.label);
  return result;
}

TEST(Axis, ALogarithmicAxisPutsEqualRatiosAtEqualDistances) {
  const Axis axis = {Scale::kLog, 10, 1000, 0, 200};
  EXPECT_DOUBLE_EQ(axis.place_pt(10), 0);
  EXPECT_DOUBLE_EQ(axis.place_pt(100), 100);
  EXPECT_DOUBLE_EQ(axis.place_pt(1000), 200);
}

TEST(Axis, AnAxisMayRunDownwards) {
  const Axis axis = {Scale::kLinear, 0, 10, 300, 100};
  EXPECT_DOUBLE_EQ(axis.place_pt(0), 300);
  EXPECT_DOUBLE_EQ(axis.place_pt(5), 200);
}

TEST(Axis, LimitsAreRoundedToOneTwoOrFiveTimesAPowerOfTen) {
  EXPECT_DOUBLE_EQ(round_up_125(1), 1);
  EXPECT_DOUBLE_EQ(round_up_125(1.1), 2);
  EXPECT_DOUBLE_EQ(round_up_125(4999), 5000);
  EXPECT_DOUBLE_EQ(round_up_125(5001), 10000);
  EXPECT_DOUBLE_EQ(round_down_125(4999), 2000);
  EXPECT_DOUBLE_EQ(round_down_125(1000), 1000);
  EXPECT_DOUBLE_EQ(round_down_125(0.7), 0.5);
}

TEST(Axis, LinearTicksStandAtRoundSteps) {
  EXPECT_THAT(labels(linear_ticks(0, 100, 6)), ElementsAre("0", "20", "40", "60", "80", "100"));
  EXPECT_THAT(labels(linear_ticks(0, 0.5, 5)), ElementsAre("0", "0.1", "0.2", "0.3", "0.4", "0.5"));
}

TEST(Axis, CountedThingsHaveNoTicksBetweenThem) {
  EXPECT_THAT(labels(linear_ticks(0, 3, 6, 1)), ElementsAre("0", "1", "2", "3"));
}

TEST(Axis, LogTicksAreLabelledAtPowersOfTenAndOnShortAxesBetween) {
  EXPECT_THAT(labels(log_ticks(10, 5000)), ElementsAre("10", "100", "1000"));
  EXPECT_THAT(labels(log_ticks(200, 5000)), ElementsAre("200", "500", "1000", "2000", "5000"));
}

TEST(Axis, LongNumbersAreGroupedByThreeDigits) {
  EXPECT_EQ(grouped(1000), "1000");
  EXPECT_EQ(grouped(12345), "12\u202f345");
  EXPECT_EQ(grouped(1234567), "1\u202f234\u202f567");
  EXPECT_EQ(grouped(0.25), "0.25");
}

TEST(FreePlace, ALabelAvoidsLinesBoxesAndThePagesEdge) {
  FreePlace page({0, 0, 100, 100});
  page.take(Box{0, 0, 50, 50});
  const std::vector<Place> line = {{0, 75}, {100, 75}};
  page.take(line);
  EXPECT_FALSE(page.is_free({10, 10, 20, 20}));
  EXPECT_FALSE(page.is_free({60, 70, 70, 80}));
  EXPECT_FALSE(page.is_free({95, 10, 105, 20}));
  EXPECT_TRUE(page.is_free({60, 10, 90, 60}));
}

TEST(FreePlace, WhereNothingIsFreeTheFirstCandidateIsTaken) {
  FreePlace page({0, 0, 100, 100});
  page.take(Box{0, 0, 100, 100});
  const std::vector<Box> candidates = {{10, 10, 20, 20}, {30, 30, 40, 40}};
  EXPECT_DOUBLE_EQ(page.take_first(candidates).left_pt, 10);
}

TEST(Spread, HeightsThatAreFarApartStay) {
  std::vector<double> heights = {10, 80, 40};
  spread(heights, 10, 0, 100);
  EXPECT_THAT(heights, ElementsAre(DoubleEq(10), DoubleEq(80), DoubleEq(40)));
}

TEST(Spread, HeightsThatTouchAreMovedApartAroundTheirMean) {
  std::vector<double> heights = {50, 50, 50};
  spread(heights, 10, 0, 100);
  EXPECT_THAT(heights, ElementsAre(DoubleEq(40), DoubleEq(50), DoubleEq(60)));
}

TEST(Spread, HeightsStayWithinTheirLimits) {
  std::vector<double> heights = {99, 98, 1};
  spread(heights, 10, 5, 95);
  EXPECT_THAT(heights, ElementsAre(DoubleEq(95), DoubleEq(85), DoubleEq(5)));
}

}  // namespace
}  // namespace vestige::plot
