#include "analysis/claims.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vestige {
namespace {

using ::testing::HasSubstr;

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

TEST(Claims, AreNotMadeOfOtherJson) {
  EXPECT_TRUE(claims_of(nlohmann::json::array(), "a.json").empty());
  EXPECT_TRUE(claims_of(result(), "a.json").empty());
}

}  // namespace
}  // namespace vestige
