// The built-in scenario `slide` on the built-in body: what `phantom` is for.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/support/builtin_avatar.hpp"
#include "tests/support/builtin_map.hpp"
#include "tests/support/finer_map.hpp"
#include "tests/support/mapping_run.hpp"

namespace vestige {
namespace {

using test::metric;

const ContactRecording& slide() {
  static const ContactRecording recording = test::record_scenario("slide", test::builtin_avatar(), 10, 480, 60);
  return recording;
}

std::vector<Scores> judge(const ActuatorMap& map) {
  const ActuatorLayout layout(test::builtin_avatar(), map);
  std::vector<LawChoice> laws(2);
  laws[1].name = "phantom";
  return score_all(slide(), {&layout}, laws);
}

TEST(SlideScenario, IsASlideOfManyContacts) {
  EXPECT_GT(slide().contacts.size(), 1000U);
}

void expect_half_as_far_off(const ActuatorMap& map, const char* name) {
  const std::vector<Scores> scores = judge(map);
  for (std::size_t k = 0; k < metrics().size(); ++k)
    ::testing::Test::RecordProperty(
        std::string(name) + "_" + metrics()[k].name,
        std::to_string(scores[0][k]) + " binary, " + std::to_string(scores[1][k]) + " phantom");
  EXPECT_GT(metric(scores[0], "coverage"), 0.9) << name;
  EXPECT_LE(metric(scores[1], "localisation_error_mm"), 0.5 * metric(scores[0], "localisation_error_mm")) << name;
  EXPECT_LT(metric(scores[1], "slide_jump_mm"), 0.6 * metric(scores[0], "slide_jump_mm")) << name;
  EXPECT_NEAR(metric(scores[1], "slide_ripple"), 0, 0.01) << name;
}

TEST(SlideScenario, UnderPhantomIsFeltAtMostHalfAsFarOffAsUnderBinary) {
  expect_half_as_far_off(test::builtin_map(), "paper_6");
  expect_half_as_far_off(test::finer_map(8, 2), "torso_16");
  expect_half_as_far_off(test::finer_map(8, 5), "torso_40");
}

}  // namespace
}  // namespace vestige
