// The parts of a film that know neither OpenGL nor files.

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "analysis/plot/film/duty_columns.hpp"
#include "analysis/plot/film/film_plan.hpp"

namespace vestige::plot {
namespace {

/// The periods of the film that show frames at this rate, and which frames they are.
std::vector<std::pair<int, int>> shown(double trace_hz, int frames, const FilmSpan& span) {
  FilmClock clock(span);
  std::vector<std::pair<int, int>> result;
  for (int frame = 0; frame < frames; ++frame)
    if (const auto period = clock.period_of(frame / trace_hz)) result.emplace_back(*period, frame);
  return result;
}

TEST(FilmClock, TakesTheFirstFrameInEachPeriod) {
  const FilmSpan span = {.rate_hz = 25};
  EXPECT_EQ(shown(1000, 100, span), (std::vector<std::pair<int, int>>{{0, 0}, {1, 40}, {2, 80}}));
  EXPECT_EQ(shown(90, 12, span), (std::vector<std::pair<int, int>>{{0, 0}, {1, 4}, {2, 8}, {3, 11}}));
}

TEST(FilmClock, ASlowTraceKeepsItsFramesForSeveralPeriods) {
  EXPECT_EQ(shown(10, 4, {.rate_hz = 25}), (std::vector<std::pair<int, int>>{{0, 0}, {2, 1}, {5, 2}, {7, 3}}));
}

TEST(FilmClock, ATenthOfTheSpeedShowsTenTimesAsManyFrames) {
  EXPECT_EQ(shown(1000, 1000, {.speed = 0.1, .rate_hz = 25}).size(), 250U);
  EXPECT_EQ(shown(1000, 1000, {.speed = 10, .rate_hz = 25}).size(), 3U);
}

TEST(FilmClock, BeginsWithTheFirstFrameOfTheSpan) {
  EXPECT_EQ(shown(100, 100, {.from_s = 0.305, .to_s = 0.4, .rate_hz = 25}),
            (std::vector<std::pair<int, int>>{{0, 31}, {1, 35}, {2, 39}}));
}

/// The length of a film of these frames, in periods of a second.
std::uint64_t length_of(const std::vector<double>& times_s) {
  FilmClock clock({.rate_hz = 1});
  bool is_shown = true;
  for (const double time_s : times_s) is_shown = clock.period_of(time_s).has_value();
  if (!is_shown) clock.last_period();
  return clock.periods();
}

TEST(FilmClock, TheLastFrameIsShownInAPeriodOfItsOwn) {
  FilmClock clock({.rate_hz = 1});
  EXPECT_EQ(clock.period_of(0), 0U);
  EXPECT_EQ(clock.period_of(1), 1U);
  EXPECT_FALSE(clock.period_of(1.9));
  EXPECT_EQ(clock.last_period(), 2U);
  EXPECT_EQ(clock.periods(), 3U);
}

TEST(FilmClock, TheLastPictureStaysForTheShortestTimeOfTheOthers) {
  EXPECT_EQ(length_of({7}), 1U);
  EXPECT_EQ(length_of({0, 3, 5, 100}), 102U) << "the gap before it is no time that it lasts";
  EXPECT_EQ(length_of({0, 3, 5, 100, 100.5}), 102U);
}

class DutyColumnsTest : public ::testing::Test {
 protected:
  void add(double time_s, std::uint8_t first, std::uint8_t second) {
    columns_.add(time_s, std::array<std::uint8_t, 2>{first, second});
  }
  std::vector<int> row(std::size_t actuator) const {
    const auto begin = columns_.highest().begin() + static_cast<std::ptrdiff_t>(actuator * 5);
    return {begin, begin + 5};
  }

  DutyColumns columns_{2, 5, 10, 15};
};

TEST_F(DutyColumnsTest, APulseOfOneFrameIsNotLost) {
  add(10, 0, 0), add(12.3, 0, 200), add(12.301, 0, 0), add(14.9, 7, 0);
  columns_.finish();
  EXPECT_EQ(row(0), (std::vector<int>{0, 0, 0, 0, 7}));
  EXPECT_EQ(row(1), (std::vector<int>{0, 0, 200, 0, 0}));
}

TEST_F(DutyColumnsTest, ADutyHoldsUntilTheNextFrameAndTheEnd) {
  add(9, 50, 1), add(12, 0, 2);
  columns_.finish();
  EXPECT_EQ(row(0), (std::vector<int>{50, 50, 0, 0, 0}));
  EXPECT_EQ(row(1), (std::vector<int>{1, 1, 2, 2, 2}));
}

TEST_F(DutyColumnsTest, ADutyIsSeenInTheColumnInWhichItEnds) {
  add(10, 200, 0), add(12.9, 0, 30), add(14, 0, 0);
  columns_.finish();
  EXPECT_EQ(row(0), (std::vector<int>{200, 200, 200, 0, 0}));
  EXPECT_EQ(row(1), (std::vector<int>{0, 0, 30, 30, 0})) << "it ends with a column";
}

TEST_F(DutyColumnsTest, WhatLiesOutsideIsNotShown) {
  add(8, 90, 0), add(9.5, 0, 0), add(15, 0, 90), add(17, 90, 90);
  columns_.finish();
  EXPECT_EQ(row(0), std::vector<int>(5, 0));
  EXPECT_EQ(row(1), std::vector<int>(5, 0));
}

}  // namespace
}  // namespace vestige::plot
