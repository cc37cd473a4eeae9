// Rankings whose outcome is known.

#include "analysis/batch/ranking.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace vestige {
namespace {

constexpr std::uint64_t kSeed = 1;

/// Candidates of one metric.
std::vector<CandidateValues> candidates(std::vector<std::vector<double>> values) {
  std::vector<CandidateValues> list;
  for (std::vector<double>& one : values) list.push_back({std::move(one)});
  return list;
}

/// All traces are files, or of one scenario.
std::vector<std::size_t> alike(std::size_t traces) {
  return std::vector<std::size_t>(traces, 0);
}

TEST(Ranking, PutsTheBestMeanFirst) {
  const auto values = candidates({{5, 7, 6}, {1, 2, 3}, {9, 9, 9}});
  const auto low = rank_candidates(values, alike(3), 0, RankDirection::kLowerIsBetter, kSeed);
  ASSERT_EQ(low.size(), 3U);
  EXPECT_EQ(low[0].candidate, 1U);
  EXPECT_EQ(low[1].candidate, 0U);
  EXPECT_EQ(low[2].candidate, 2U);
  EXPECT_EQ(low[2].rank, 3U);
  EXPECT_EQ(low[1].metrics[0].mean, 6);
  const auto high = rank_candidates(values, alike(3), 0, RankDirection::kHigherIsBetter, kSeed);
  EXPECT_EQ(high[0].candidate, 2U);
}

TEST(Ranking, EqualMeansShareARankAndTheNextIsCountedOn) {
  const auto ranking =
      rank_candidates(candidates({{2, 2}, {1, 3}, {4, 4}}), alike(2), 0, RankDirection::kLowerIsBetter, kSeed);
  EXPECT_EQ(ranking[0].candidate, 0U) << "the order given breaks ties";
  EXPECT_EQ(ranking[0].rank, 1U);
  EXPECT_EQ(ranking[1].rank, 1U);
  EXPECT_EQ(ranking[2].rank, 3U);
}

/// Traces differ by far more than candidates; the difference is about the same on each, so it is certain.
TEST(Ranking, ADifferenceThatEveryTraceShowsIsSeenHoweverMuchTracesDiffer) {
  const auto ranking =
      rank_candidates(candidates({{10, 100, 1000, 5, 50, 20, 70, 300, 4}, {11, 101, 1001.1, 6, 51, 21, 70.9, 301, 5}}),
                      alike(9), 0, RankDirection::kLowerIsBetter, kSeed);
  EXPECT_TRUE(ranking[1].is_worse());
  EXPECT_NEAR(ranking[1].against_leader->interval.low, 1, 0.1);
  EXPECT_NEAR(ranking[1].against_leader->interval.high, 1, 0.1);
  EXPECT_LT(ranking[1].metrics[0].interval.low, ranking[0].metrics[0].interval.high)
      << "though their intervals overlap";
}

TEST(Ranking, ADifferenceThatGoesBothWaysIsNotDistinguishable) {
  const auto ranking = rank_candidates(candidates({{1, 5, 3, 8, 2, 6, 4, 7}, {2, 4, 4, 7.5, 3, 5, 5, 6.5}}), alike(8),
                                       0, RankDirection::kLowerIsBetter, kSeed);
  EXPECT_TRUE(ranking[1].is_compared());
  EXPECT_FALSE(ranking[1].is_worse());
  EXPECT_FALSE(ranking[0].is_compared());
}

TEST(Ranking, FewTracesDistinguishNothing) {
  const auto ranking = rank_candidates(candidates({{1, 1, 1, 1, 1, 1, 1}, {100, 101, 102, 103, 104, 105, 106}}),
                                       alike(7), 0, RankDirection::kLowerIsBetter, kSeed);
  EXPECT_EQ(ranking[1].rank, 2U);
  EXPECT_FALSE(ranking[1].is_compared());
  EXPECT_TRUE(std::isnan(ranking[1].metrics[0].interval.low));
}

TEST(Ranking, MissingValuesAreLeftOutAndACandidateWithoutAnyHasNoRank) {
  const auto ranking = rank_candidates(candidates({{kMissing, kMissing, kMissing}, {4, kMissing, 6}, {3, 3, 3}}),
                                       alike(3), 0, RankDirection::kLowerIsBetter, kSeed);
  EXPECT_EQ(ranking[0].candidate, 2U);
  EXPECT_EQ(ranking[1].candidate, 1U);
  EXPECT_EQ(ranking[1].metrics[0].mean, 5);
  EXPECT_EQ(ranking[1].metrics[0].n, 2U);
  EXPECT_EQ(ranking[2].candidate, 0U);
  EXPECT_FALSE(ranking[2].rank.has_value());
}

TEST(Ranking, OfNothingIsEmpty) {
  EXPECT_TRUE(rank_candidates({}, {}, 0, RankDirection::kLowerIsBetter, kSeed).empty());
}

}  // namespace
}  // namespace vestige
