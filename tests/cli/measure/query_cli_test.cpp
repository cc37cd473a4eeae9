// `vestige query` as a user runs it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/support/process.hpp"
#include "tests/support/test_data.hpp"

namespace vestige {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class QueryCommandLine : public ::testing::Test {
 protected:
  test::Outcome run(const std::string& command) const { return test::run(command, folder_.path()); }

  /// A point that falls through a triangle at rest, and what the file claims about it.
  void write_query(const std::string& name, int truth) const {
    std::ofstream file(folder_ / name);
    for (const char* point : {"1,1,1,1,1,1", "0,1,0,1,0,1", "4,1,0,1,0,1", "0,1,4,1,0,1", "1,1,1,1,-1,1", "0,1,0,1,0,1",
                              "4,1,0,1,0,1", "0,1,4,1,0,1"})
      file << point << ',' << truth << '\n';
  }

  const test::TemporaryFolder folder_;
};

TEST_F(QueryCommandLine, SaysThatEveryAnswerIsRight) {
  write_query("right.csv", 1);
  for (const char* flags : {"", "--detector exact", "--method static", "--round-fp32", "--round-fp32 --detector exact",
                            "--round-fp32 --method static"}) {
    const test::Outcome outcome = run(std::string("vestige query right.csv right.csv --json - -q ") + flags);
    EXPECT_EQ(outcome.exit_code, 0) << flags << outcome.standard_error;
    const auto json = nlohmann::json::parse(outcome.standard_output, nullptr, false);
    ASSERT_TRUE(json.contains("total")) << flags;
    EXPECT_EQ(json["files"][1]["name"], "right.csv");
    EXPECT_EQ(json["total"]["queries"], 2);
    EXPECT_EQ(json["total"]["positives"], 2);
    EXPECT_EQ(json["total"]["false_negatives"], 0);
    EXPECT_EQ(json["total"]["false_positives"], 0);
  }
}

TEST_F(QueryCommandLine, AFalseAnswerFailsTheCheckAndIsNamed) {
  write_query("wrong.csv", 0);
  const test::Outcome outcome = run("vestige query wrong.csv");
  EXPECT_EQ(outcome.exit_code, 4);
  EXPECT_THAT(outcome.standard_output, HasSubstr("wrong.csv"));
  EXPECT_THAT(outcome.standard_error, AllOf(HasSubstr("1 false contact,"), HasSubstr("lines 1")));
}

TEST_F(QueryCommandLine, ABrokenFileIsAnErrorAndLeavesNothingBehind) {
  write_query("right.csv", 1);
  std::ofstream(folder_ / "broken.csv") << "1,1,1,1,1,1,1\n";
  const test::Outcome outcome = run("vestige query right.csv broken.csv --json out.json");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.standard_error, HasSubstr("broken.csv, line 1: "));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out.json"));
  EXPECT_EQ(run("vestige query absent.csv").exit_code, 1);
  EXPECT_EQ(run("vestige query").exit_code, 2);
}

TEST_F(QueryCommandLine, GeometryWantsFp32) {
  write_query("right.csv", 1);
  const test::Outcome outcome = run("vestige query right.csv --detector geometry");
  EXPECT_EQ(outcome.exit_code, 2);
}

TEST_F(QueryCommandLine, AnswersThePublicQueriesWithoutAFalseOne) {
  VESTIGE_REQUIRE_DATA(test::data("ccd/handcrafted"));
  const std::string data = test::data("ccd").string();
  const test::Outcome outcome = run("vestige query " + data + "/handcrafted/*/vertex-face/*.csv " + data +
                                    "/simulation/*.csv --method ccd --detector cpu --json -");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.standard_error;
  const auto json = nlohmann::json::parse(outcome.standard_output, nullptr, false);
  EXPECT_EQ(json["total"]["queries"], 2478);
  EXPECT_EQ(json["total"]["false_negatives"], 0);
  EXPECT_EQ(json["total"]["false_positives"], 0);
}

}  // namespace
}  // namespace vestige
