// Runs vestige stress as a user does.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/support/command_line.hpp"
#include "tests/support/gl/gl_context.hpp"
#include "traces/files/input_file.hpp"

namespace vestige {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class StressCommand : public test::CommandLineTest {
 protected:
  std::string text_of(const std::string& name) const { return read_text_file(folder_ / name); }

  void expect_refusal(const std::string& flags, const std::string& word) const {
    const test::Outcome outcome = run("vestige stress " + flags);
    EXPECT_EQ(outcome.exit_code, 2) << flags;
    EXPECT_THAT(outcome.standard_error, HasSubstr(word)) << flags;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "s" / "stress.json")) << flags;
  }
};

TEST_F(StressCommand, WritesTheSameResultsForTheSameSeed) {
  const std::string stress =
      "vestige stress --families vertex,watertight --detector cpu,embree,embree_default --n 50 --no-figure ";
  ASSERT_EQ(run(stress + "-o a").exit_code, 0);
  ASSERT_EQ(run(stress + "-o b").exit_code, 0);
  ASSERT_EQ(run(stress + "-o c --seed 2").exit_code, 0);
  EXPECT_EQ(text_of("a/stress.json"), text_of("b/stress.json"));
  EXPECT_NE(text_of("a/stress.json"), text_of("c/stress.json"));
  EXPECT_THAT(text_of("a/run.json"), AllOf(HasSubstr("argv"), HasSubstr("commit"), HasSubstr("seconds")));
}

TEST_F(StressCommand, AnswersWithCountsForEveryDetectorFamilyAndMagnitude) {
  const auto json = json_of("vestige stress --families edge --detector paper,cpu --n 30 --no-figure -o s --json - -q" +
                            test::gl_flags());
  ASSERT_EQ(json["families"].size(), 3 * (1 + 2));  // three magnitudes; paper knows one method, cpu two of these
  for (const auto& one : json["families"]) {
    EXPECT_EQ(one["name"], "edge");
    EXPECT_EQ(one["cases"], 30);
    if (one["detector"] == "paper") continue;
    EXPECT_EQ(one["false_negatives"], 0);
    EXPECT_EQ(one["false_positives"], 0);
    EXPECT_EQ(one["wrong_winner"], 0);
    EXPECT_TRUE(one["unsure"].is_number());
  }
  EXPECT_FALSE(json["gl"].is_null());
}

TEST_F(StressCommand, PrintsATableAndWhatEachFamilyIs) {
  const test::Outcome outcome =
      run("vestige stress --families needle,denormal --detector cpu --n 20 --no-figure -o s -v");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.standard_output, AllOf(HasSubstr("needle"), HasSubstr("1e-40"), Not(HasSubstr("vertex"))));
  EXPECT_THAT(outcome.standard_error, HasSubstr("zero_length: Colliders that rest on the surface."));
}

TEST_F(StressCommand, RefusesWhatItDoesNotKnow) {
  expect_refusal("--families vertex,magic -o s", "magic");
  expect_refusal("--families vertex,vertex -o s", "twice");
  expect_refusal("--detector cpu,magic -o s", "magic");
  expect_refusal("--method static,magic -o s", "magic");
  expect_refusal("--n 0 -o s", "--n");
  expect_refusal("--n 10", "-o");
}

TEST_F(StressCommand, OverwritesNothingUnasked) {
  const std::string stress = "vestige stress --families vertex --detector cpu --n 10 --no-figure -o s";
  ASSERT_EQ(run(stress).exit_code, 0);
  EXPECT_EQ(run(stress).exit_code, 1);
  EXPECT_EQ(run(stress + " --force").exit_code, 0);
}

}  // namespace
}  // namespace vestige
