#include "analysis/base/stratified_bootstrap.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace vestige {
namespace {

/// `strata` strata of `units` units each.
std::vector<std::size_t> in_strata(std::size_t strata, std::size_t units) {
  std::vector<std::size_t> of_unit;
  for (std::size_t s = 0; s < strata; ++s) of_unit.insert(of_unit.end(), units, s);
  return of_unit;
}

TEST(StratifiedBootstrap, WhatDiffersBetweenStrataDoesNotWidenTheInterval) {
  std::vector<double> values;
  for (int stratum = 0; stratum < 4; ++stratum)
    for (int unit = 0; unit < 5; ++unit) values.push_back(100 * stratum + unit);
  const MeanInterval apart = StratifiedBootstrap(in_strata(4, 5), 1).mean(values);
  EXPECT_DOUBLE_EQ(apart.mean, 152);
  EXPECT_LT(apart.interval.high - apart.interval.low, 4);
  const MeanInterval together = StratifiedBootstrap(in_strata(1, 20), 1).mean(values);
  EXPECT_GT(together.interval.high - together.interval.low, 80);
}

TEST(StratifiedBootstrap, FewUnitsGiveNoInterval) {
  const std::vector<double> seven = {1, 2, 3, 4, 5, 6, 7};
  EXPECT_TRUE(std::isnan(StratifiedBootstrap(in_strata(1, 7), 1).mean(seven).interval.low));
  EXPECT_DOUBLE_EQ(StratifiedBootstrap(in_strata(1, 7), 1).mean(seven).mean, 4);
  EXPECT_FALSE(StratifiedBootstrap(in_strata(12, 1), 1).has_intervals());
  EXPECT_TRUE(StratifiedBootstrap(in_strata(1, 8), 1).has_intervals());
  EXPECT_FALSE(StratifiedBootstrap(in_strata(9, 4), 1).has_intervals());
  EXPECT_TRUE(StratifiedBootstrap(in_strata(2, 5), 1).has_intervals());
}

TEST(StratifiedBootstrap, MissingValuesAreLeftOut) {
  std::vector<double> values(12, 3.0);
  values[4] = std::nan("");
  const MeanInterval mean = StratifiedBootstrap(in_strata(1, 12), 1).mean(values);
  EXPECT_EQ(mean.n, 11U);
  EXPECT_DOUBLE_EQ(mean.mean, 3);
  EXPECT_DOUBLE_EQ(mean.interval.low, 3);
}

TEST(StratifiedBootstrap, TellsAClearLoserFromTheLeaderAndNotATie) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> noise(0, 1);
  std::vector<std::vector<double>> candidates(3);
  for (int unit = 0; unit < 20; ++unit) {
    const double hard = 10 * noise(random);  // for all candidates
    candidates[0].push_back(50 + hard + noise(random));
    candidates[1].push_back(50 + hard + noise(random));
    candidates[2].push_back(54 + hard + noise(random));
  }
  const auto tests = StratifiedBootstrap(in_strata(1, 20), 1).against_leader(candidates, 1);
  const std::size_t leader = tests[0]->difference == 0 ? 0 : 1;
  EXPECT_GT(tests[1 - leader]->p_holm, 0.05);
  EXPECT_LT(tests[2]->p_holm, 0.01);
  EXPECT_DOUBLE_EQ(tests[2]->p_holm, 2 * tests[2]->p) << "the smaller of two, by Holm's correction";
  EXPECT_DOUBLE_EQ(tests[1 - leader]->p_holm, tests[1 - leader]->p);
  EXPECT_NEAR(tests[2]->difference, 4, 1);
  EXPECT_GT(tests[2]->interval.low, 2);
  // The same with higher values for the better ones.
  for (auto& values : candidates)
    for (double& value : values) value = -value;
  const auto higher = StratifiedBootstrap(in_strata(1, 20), 1).against_leader(candidates, -1);
  EXPECT_DOUBLE_EQ(higher[2]->difference, -tests[2]->difference);
  EXPECT_DOUBLE_EQ(higher[2]->p, tests[2]->p);
}

TEST(StratifiedBootstrap, TwoThatDifferInOneUnitAreBothToldFromTheLeader) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> noise(0, 1);
  std::vector<std::vector<double>> candidates(3);
  for (int unit = 0; unit < 20; ++unit) {
    candidates[0].push_back(20 + noise(random));
    candidates[1].push_back(126 + noise(random));
    candidates[2].push_back(candidates[1].back());
  }
  candidates[2][7] += 0.02;  // resamples without this unit do not tell the two apart
  const auto tests = StratifiedBootstrap(in_strata(1, 20), 1).against_leader(candidates, 1);
  EXPECT_LT(tests[1]->p_holm, 0.001);
  EXPECT_LT(tests[2]->p_holm, 0.001);
}

TEST(StratifiedBootstrap, LeadersThatAreTheSameAreNotTold) {
  std::vector<std::vector<double>> candidates(3);
  for (int unit = 0; unit < 12; ++unit) {
    candidates[0].push_back(10 + unit % 5);
    candidates[1].push_back(10 + unit % 5);
    candidates[2].push_back(20 + unit % 3);
  }
  const auto tests = StratifiedBootstrap(in_strata(1, 12), 1).against_leader(candidates, -1);
  EXPECT_LT(tests[0]->p_holm, 0.05);  // now the highest is the best
  const auto lowest = StratifiedBootstrap(in_strata(1, 12), 1).against_leader(candidates, 1);
  for (const std::size_t leader : {0U, 1U}) {
    EXPECT_EQ(lowest[leader]->p, 1);
    EXPECT_EQ(lowest[leader]->p_holm, 1);
    EXPECT_EQ(lowest[leader]->difference, 0);
  }
  EXPECT_LT(lowest[2]->p_holm, 0.05);
}

}  // namespace
}  // namespace vestige
