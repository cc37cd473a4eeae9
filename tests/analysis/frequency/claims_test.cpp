#include "analysis/frequency/claims.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vestige {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

nlohmann::json result() {
  return {{"argv", {"build/bin/vestige", "sweep", "-o", "out"}},
          {"time", "2026-01-02T03:04:05Z"},
          {"commit", "0123456789abcdef"},
          {"dirty", true},
          {"machine", {{"processor", "Abacus"}, {"cores", 2}}}};
}

TEST(Claims, QuoteASweepAtThePapersCountsWithIntervalAndOrigin) {
  nlohmann::json sweep = result();
  const auto point = [](int colliders, double hz) {
    return nlohmann::json{{"colliders", colliders}, {"hz", hz}, {"hz_low", hz - 1}, {"hz_high", hz + 1}};
  };
  sweep["series"] = {{{"detector", "paper"},
                      {"context", "osmesa"},
                      {"gl", {{"renderer", "softpipe"}}},
                      {"points", {point(1, 100), point(2, 90), point(40, 50)}}}};
  const auto claims = claims_of(sweep, "run/sweep.json");
  ASSERT_EQ(claims.size(), 1U);
  EXPECT_EQ(claims[0].claim,
            "`paper` on osmesa detects at 100 Hz (99 to 101) with 1, 50 Hz (49 to 51) with 40 colliders");
  EXPECT_EQ(claims[0].command, "vestige sweep -o out");
  EXPECT_EQ(claims[0].machine, "Abacus, 2 cores; softpipe");
  EXPECT_EQ(claims[0].commit, "0123456789+");
  EXPECT_THAT(claims_table(claims), HasSubstr("[run/sweep.json](run/sweep.json)"));
}

TEST(Claims, SayWhatIsNotComplete) {
  nlohmann::json record = result();
  record["frames"] = 10;
  record["recording_s"] = 2;
  EXPECT_THAT(claims_of(record, "a.json")[0].claim, Not(HasSubstr("complete")));
  record["complete"] = false;
  EXPECT_THAT(claims_of(record, "a.json")[0].claim, HasSubstr("**not complete**"));
}

TEST(Claims, SumAStressUpAndTakeItsOriginFromTheRunBesideIt) {
  const auto row = [](const char* detector, int missed) {
    return nlohmann::json{{"detector", detector},      {"method", "static"},   {"cases", 10},
                          {"false_negatives", missed}, {"false_positives", 1}, {"wrong_winner", 0}};
  };
  const nlohmann::json stress = {{"families", {row("cpu", 0), row("paper", 2), row("paper", 3)}}};
  nlohmann::json run = result();
  run["gl"] = {{"renderer", "softpipe"}};
  const auto claims = claims_of(with_run(stress, run), "stress.json");
  ASSERT_EQ(claims.size(), 2U);
  EXPECT_THAT(claims[0].claim, HasSubstr("`cpu` with `static`, of 10 hostile cases: 0 false negatives"));
  EXPECT_THAT(claims[1].claim, HasSubstr("of 20 hostile cases: 5 false negatives, 2 false positives"));
  EXPECT_EQ(claims[1].machine, "Abacus, 2 cores; softpipe");
}

TEST(Claims, QuoteWhatEachDetectorMissesAtEachRate) {
  nlohmann::json accuracy = {{"duration_s", 1.0}};
  const nlohmann::json points = {{{"rate_hz", 60.0}, {"missed_share", 0.125}},
                                 {{"rate_hz", 1000.0}, {"missed_share", 0.0}}};
  accuracy["scenes"] = {{{"colliders", "hug"},
                         {"truth", {{"events", 8}}},
                         {"series", {{{"detector", "paper"}, {"method", "static"}, {"points", points}}}}}};
  const auto claims = claims_of(with_run(accuracy, result()), "accuracy.json");
  ASSERT_EQ(claims.size(), 1U);
  EXPECT_EQ(claims[0].claim,
            "`paper` with `static`, hug: of 8 true contacts it misses 12.5 % at 60 Hz, 0.0 % at 1000 Hz");
}

TEST(Claims, SumAgreementUp) {
  nlohmann::json agreement = result();
  agreement["method"] = "ccd";
  agreement["families"] = {{"edge", {{"pairs", 7}, {"differences", 0}}},
                           {"vertex", {{"pairs", 5}, {"differences", 1}}}};
  agreement["total"] = {{"pairs", 12}, {"differences", 1}};
  const auto claims = claims_of(agreement, "a.json");
  ASSERT_EQ(claims.size(), 1U);
  EXPECT_EQ(claims[0].claim, "the deciding code and the slow truth differ in 1 of 12 pairs (`ccd`)");
}

TEST(Claims, AreNotMadeOfOtherJson) {
  EXPECT_TRUE(claims_of(nlohmann::json::array(), "a.json").empty());
  EXPECT_TRUE(claims_of(result(), "a.json").empty());
}

}  // namespace
}  // namespace vestige
