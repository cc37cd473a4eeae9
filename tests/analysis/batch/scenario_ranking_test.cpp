// Which traces belong together, and what one scenario alone would say.

#include "analysis/batch/scenario_ranking.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "analysis/base/statistics.hpp"

namespace vestige {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Traces of a batch, and the names of those that could be used.
struct Traces {
  nlohmann::ordered_json batch = {{"traces", nlohmann::ordered_json::array()}};
  std::vector<std::string> names;

  void add_scenario(const std::string& scenario, int seeds) {
    for (int seed = 1; seed <= seeds; ++seed)
      add({{"name", scenario + std::to_string(seed)}, {"given", scenario}, {"seed", seed}});
  }
  void add_files(int files) {
    for (int file = 1; file <= files; ++file)
      add({{"name", "file" + std::to_string(file)}, {"given", "file" + std::to_string(file) + ".mcap"}});
  }
  void add(const nlohmann::ordered_json& trace) {
    batch["traces"].push_back(trace);
    names.push_back(trace["name"].get<std::string>());
  }
  TraceGroups groups() const { return group_traces(batch, names); }
};

TEST(TraceGroups, SeedsOfAScenarioAndFilesBelongTogether) {
  Traces traces;
  traces.add_scenario("slide", 5);
  traces.add_files(8);
  traces.add_scenario("hug", 5);
  const TraceGroups groups = traces.groups();
  EXPECT_EQ(groups.names, (std::vector<std::string>{"slide", "files", "hug"}));
  EXPECT_EQ(groups.over, "2 scenarios x 5 seeds and 8 files");
  EXPECT_THAT(groups.why_no_intervals, IsEmpty());
  EXPECT_EQ(groups.strata, groups.of_trace);
}

TEST(TraceGroups, SayWhyThereAreNoIntervals) {
  const auto why = [](int slides, int hugs, int files) {
    Traces traces;
    traces.add_scenario("slide", slides);
    traces.add_scenario("hug", hugs);
    traces.add_files(files);
    return traces.groups().why_no_intervals;
  };
  EXPECT_THAT(why(0, 0, 8), IsEmpty());
  EXPECT_THAT(why(0, 0, 7), HasSubstr("only 7 files"));
  EXPECT_THAT(why(20, 20, 7), HasSubstr("only 7 files"));
  EXPECT_THAT(why(1, 1, 0), HasSubstr("each scenario was recorded with one seed"));
  EXPECT_THAT(why(20, 1, 0), HasSubstr("hug has 1 seed and intervals need 5"));
  EXPECT_THAT(why(5, 4, 0), HasSubstr("hug has 4 seeds"));
  EXPECT_THAT(why(4, 4, 0), HasSubstr("2 scenarios x 4 seeds are too few"));
  EXPECT_THAT(why(5, 5, 0), IsEmpty());
}

TEST(ScenarioRanking, PointsOutWhereAnotherIsFirst) {
  Traces traces;
  traces.add_scenario("slide", 2);
  traces.add_scenario("hug", 2);
  traces.add_scenario("rain", 2);
  traces.add_scenario("orbit", 2);
  const std::vector<CandidateValues> values = {{{1, 2, 9, 9, 5, 5, kMissing, kMissing}},
                                               {{3, 3, 8, 8, 4, 4, kMissing, kMissing}},
                                               {{9, 9, 9, 9, 9, 9, kMissing, kMissing}}};
  const std::vector<std::vector<double>> headlines = {values[0][0], values[1][0], values[2][0]};
  const TraceGroups groups = traces.groups();
  const auto pooled = rank_candidates(values, groups.strata, 0, RankDirection::kLowerIsBetter, 1);
  ASSERT_EQ(pooled.front().candidate, 1U);
  const auto alone = rank_by_scenario(headlines, groups, RankDirection::kLowerIsBetter, 1);
  ASSERT_EQ(alone.size(), 4U);
  EXPECT_EQ(alone[0].traces, 2U);
  EXPECT_EQ(alone[0].ranking[0].candidate, 0U);
  EXPECT_DOUBLE_EQ(alone[0].ranking[0].metrics[0].mean, 1.5);
  const std::vector<std::string> names = {"binary", "phantom", "gaussian"};
  EXPECT_EQ(describe_reversals(alone, pooled, names), "on slide alone, binary is first");
}

TEST(ScenarioRanking, OfOneScenarioIsThePooledOne) {
  Traces traces;
  traces.add_scenario("slide", 8);
  EXPECT_THAT(rank_by_scenario(std::vector<std::vector<double>>{{1, 2, 3, 4, 5, 6, 7, 8}}, traces.groups(),
                               RankDirection::kLowerIsBetter, 1),
              IsEmpty());
}

}  // namespace
}  // namespace vestige
