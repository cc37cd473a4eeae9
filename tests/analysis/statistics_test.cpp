#include "analysis/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace vestige {
namespace {

TEST(Quantile, InterpolatesBetweenOrderStatistics) {
  const std::vector<double> values = {4, 1, 3, 2};
  EXPECT_DOUBLE_EQ(quantile(values, 0), 1);
  EXPECT_DOUBLE_EQ(quantile(values, 0.5), 2.5);
  EXPECT_DOUBLE_EQ(quantile(values, 0.95), 3.85);
  EXPECT_DOUBLE_EQ(quantile(values, 1), 4);
  EXPECT_TRUE(std::isnan(quantile({}, 0.5)));
}

TEST(Frequency, IsFramesOverTotalTimeNotTheMeanOfFrequencies) {
  const std::vector<Repetition> repetitions = {{10, 1}, {10, 3}};
  EXPECT_DOUBLE_EQ(frequency_hz(repetitions), 5);
}

TEST(Bootstrap, HasNoWidthWithoutSpreadAndIsTheSameEveryTime) {
  const std::vector<Repetition> steady(20, {10, 0.1});
  EXPECT_DOUBLE_EQ(bootstrap_frequency_hz(steady, 1).low, 100);
  EXPECT_DOUBLE_EQ(bootstrap_frequency_hz(steady, 1).high, 100);
  std::vector<Repetition> mixed = steady;
  for (std::size_t i = 0; i < 10; ++i) mixed[i].seconds = 0.2;
  const Interval interval = bootstrap_frequency_hz(mixed, 1);
  EXPECT_LT(interval.low, frequency_hz(mixed));
  EXPECT_GT(interval.high, frequency_hz(mixed));
  EXPECT_EQ(interval.low, bootstrap_frequency_hz(mixed, 1).low);
}

TEST(Noise, IsHalfTheInterquartileRangeOverTheMedian) {
  const std::vector<Repetition> repetitions = {{80, 1}, {90, 1}, {100, 1}, {110, 1}, {120, 1}};
  EXPECT_DOUBLE_EQ(relative_noise(repetitions), 0.1);
  EXPECT_DOUBLE_EQ(relative_noise({repetitions.data(), 1}), 0);
}

}  // namespace
}  // namespace vestige
