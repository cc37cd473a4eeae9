#include "analysis/base/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <span>
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

TEST(WilsonInterval, IsTheOneOfTheTables) {
  EXPECT_NEAR(wilson_interval(10, 100).low, 0.0552, 5e-5);  // Newcombe 1998, method 3
  EXPECT_NEAR(wilson_interval(10, 100).high, 0.1744, 5e-5);
  EXPECT_EQ(wilson_interval(0, 100).low, 0);
  EXPECT_EQ(wilson_interval(100, 100).high, 1);
  EXPECT_LT(wilson_interval(0, 3840).high, 0.001);
  EXPECT_GT(wilson_interval(0, 3830).high, 0.001);
}

TEST(BootstrapShare, IsWiderWhereErrorsComeInClusters) {
  std::vector<ClusterShare> spread;
  std::vector<ClusterShare> together;
  for (int i = 0; i < 50; ++i) {
    spread.push_back({1, 10});
    together.push_back({i < 5 ? 10.0 : 0.0, 10});
  }
  EXPECT_DOUBLE_EQ(bootstrap_share(spread, 1).low, 0.1);
  EXPECT_DOUBLE_EQ(bootstrap_share(spread, 1).high, 0.1);
  const Interval wide = bootstrap_share(together, 1);
  EXPECT_LT(wide.low, 0.04);
  EXPECT_GT(wide.high, 0.17);
  EXPECT_EQ(wide.low, bootstrap_share(together, 1).low);
}

TEST(BootstrapShare, OfNoErrorsIsThreeOverTheNumberOfClusters) {
  const std::vector<ClusterShare> none = {{0, 5}, {0, 100}, {0, 0}, {0, 1}};
  EXPECT_EQ(bootstrap_share(none, 1).low, 0);
  EXPECT_DOUBLE_EQ(bootstrap_share(none, 1).high, 1);
  EXPECT_TRUE(std::isnan(bootstrap_share({}, 1).high));
  const std::vector<ClusterShare> one = {{1, 2}, {0, 0}};
  EXPECT_TRUE(std::isnan(bootstrap_share(one, 1).high));
}

TEST(ShareStandardError, IsThatOfAMeanWhereClustersAreAlikeInSize) {
  // 20 clusters of 10, half of them with 2 parts, half with none: the share varies by 0.1 around 0.1.
  std::vector<ClusterShare> clusters;
  clusters.reserve(20);
  for (int i = 0; i < 20; ++i) clusters.push_back({i % 2 == 0 ? 2.0 : 0.0, 10});
  EXPECT_NEAR(share_standard_error(clusters), 0.1 / std::sqrt(19.0), 1e-12);
  const Interval interval = bootstrap_share(clusters, 1);
  EXPECT_NEAR((interval.high - interval.low) / 2, 1.96 * share_standard_error(clusters),
              0.006);  // shares in steps of 0.01
  EXPECT_TRUE(std::isnan(share_standard_error(std::vector<ClusterShare>{{1, 2}, {0, 0}})));
  EXPECT_NEAR(2 * 1.96 * share_standard_error(std::vector<ClusterShare>(30, {0, 4})), 0.1, 1e-12);
  EXPECT_NEAR(2 * 1.96 * share_standard_error(std::vector<ClusterShare>(30, {4, 4})), 0.1, 1e-12);
}

TEST(BootstrapShare, OfNothingButErrorsIsWithinThreeOverTheNumberOfClustersOfAll) {
  const std::vector<ClusterShare> all(30, {4, 4});
  EXPECT_DOUBLE_EQ(bootstrap_share(all, 1).low, 0.9);
  EXPECT_DOUBLE_EQ(bootstrap_share(all, 1).high, 1);
}

TEST(Frequency, IsFramesOverTotalTimeNotTheMeanOfFrequencies) {
  const std::vector<Repetition> repetitions = {{10, 1}, {10, 3}};
  EXPECT_DOUBLE_EQ(frequency_hz(repetitions), 5);
}

TEST(Bootstrap, HasNoWidthWithoutSpreadAndIsTheSameEveryTime) {
  const std::vector<Repetition> steady(20, {10, 0.1});
  EXPECT_DOUBLE_EQ(bootstrap_frequency_hz(steady, 1, 1).low, 100);
  EXPECT_DOUBLE_EQ(bootstrap_frequency_hz(steady, 1, 1).high, 100);
  std::vector<Repetition> mixed = steady;
  for (std::size_t i = 0; i < 10; ++i) mixed[i].seconds = 0.2;
  const Interval interval = bootstrap_frequency_hz(mixed, 1, 1);
  EXPECT_LT(interval.low, frequency_hz(mixed));
  EXPECT_GT(interval.high, frequency_hz(mixed));
  EXPECT_EQ(interval.low, bootstrap_frequency_hz(mixed, 1, 1).low);
}

/// Two places, one ten times as slow as the other: that is no noise.
TEST(Bootstrap, SeesNoiseWithinPlacesOnly) {
  const std::vector<Repetition> steady = {{10, 1}, {10, 0.1}, {10, 1}, {10, 0.1}, {10, 1}, {10, 0.1}};
  const Interval none = bootstrap_frequency_hz(steady, 2, 1);
  EXPECT_NEAR(none.low, frequency_hz(steady), 1e-9);
  EXPECT_NEAR(none.high, frequency_hz(steady), 1e-9);
  EXPECT_NEAR(relative_noise(steady, 2), 0, 1e-12);
  EXPECT_GT(relative_noise(steady, 1), 0.5) << "as one place";
  EXPECT_TRUE(std::isnan(bootstrap_frequency_hz(std::span(steady).first(2), 2, 1).low)) << "each place once";
}

/// Few repetitions on a busy machine: no frequency is negative, and this tells nothing.
TEST(Bootstrap, HasNoIntervalWhereTimesAreTooScattered) {
  const std::vector<Repetition> scattered = {{10, 0.01}, {10, 0.01}, {10, 1}, {10, 1}};
  EXPECT_TRUE(std::isnan(bootstrap_frequency_hz(scattered, 2, 1).low));
  EXPECT_TRUE(std::isnan(bootstrap_frequency_hz(scattered, 2, 1).high));
}

/// Of many measurements of a known frequency, about 95 % of the intervals hold it, even where each place was measured
/// only twice.
TEST(Bootstrap, HoldsTheTruthAsOftenAsItSays) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> noise(0, 0.05);
  int held = 0;
  constexpr int kTimes = 400;
  for (int i = 0; i < kTimes; ++i) {
    std::vector<Repetition> repetitions;
    for (int r = 0; r < 16; ++r) repetitions.push_back({10, (1 + r % 8) * (1 + noise(random))});
    const Interval interval = bootstrap_frequency_hz(repetitions, 8, 1);
    if (interval.low <= 80.0 / 36 && 80.0 / 36 <= interval.high) ++held;
  }
  EXPECT_GT(held, 0.90 * kTimes);
  EXPECT_LT(held, 0.98 * kTimes);
}

TEST(Noise, IsHalfTheInterquartileRangeOfTheTimes) {
  const std::vector<Repetition> repetitions = {{1, 80}, {1, 90}, {1, 100}, {1, 110}, {1, 120}};
  EXPECT_NEAR(relative_noise(repetitions, 1), 0.1 * std::sqrt(5.0 / 4), 1e-12);
  EXPECT_DOUBLE_EQ(relative_noise({repetitions.data(), 1}, 1), 0);
}

/// Values of the formula, worked out with other software.
TEST(ExpandedLevel, OfFewUnitsLiesFurtherOut) {
  EXPECT_EQ(expanded_level(2), 0);
  EXPECT_NEAR(expanded_level(6), 0.00243, 1e-5);
  EXPECT_NEAR(expanded_level(20), 0.0159, 1e-4);
  EXPECT_NEAR(expanded_level(100), 0.0231, 1e-4);
  EXPECT_NEAR(expanded_level(100000), 0.025, 1e-4);
}

}  // namespace
}  // namespace vestige
