// The built-in scenario `slide` on the built-in body: what `phantom` is for.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "tests/support/builtin_avatar.hpp"
#include "tests/support/builtin_map.hpp"
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
  return score_all(slide(), layout, laws);
}

/// 4 x 5 actuators over the front of the torso, 60 mm apart, every texel of the skin with its nearest within 60 mm.
ActuatorMap front_of_twenty() {
  const Avatar& avatar = test::builtin_avatar();
  ActuatorMap map = test::builtin_map();
  map.names.clear();
  map.position_m.clear();
  std::vector<glm::dvec3> places;
  for (int row = 0; row < 5; ++row)
    for (int column = 0; column < 4; ++column)
      places.emplace_back(0.060 * (column - 1.5), 1.12 + 0.060 * row, 0.2);  // in front; taken to the skin
  map.actuator_count = places.size();
  for (const glm::dvec3& place : places) {
    map.names.push_back("front");
    map.position_m.emplace_back(place);
  }
  // Which skin is whose: where a first layout says the actuators are, by triangle.
  const ActuatorLayout rough(avatar, map);
  LocatedContact located;
  std::ranges::fill(map.actuator, std::uint16_t{0});
  for (std::uint32_t number = 0; number < avatar.triangles.size(); ++number) {
    for (int i = 0; i <= 40; ++i) {
      for (int j = 0; i + j <= 40; ++j) {
        const glm::dvec3 weight(1 - (i + j) / 40.0, i / 40.0, j / 40.0);
        rough.locate(SkinPoint{number, weight}, located);
        const auto nearest = std::ranges::min_element(located.distance_m());
        if (*nearest > 0.060F) continue;
        const glm::uvec3& corner = avatar.triangles[number];
        const glm::dvec2 at = weight.x * glm::dvec2(avatar.texture_coordinate[corner.x]) +
                              weight.y * glm::dvec2(avatar.texture_coordinate[corner.y]) +
                              weight.z * glm::dvec2(avatar.texture_coordinate[corner.z]);
        const auto column = std::min(static_cast<std::uint32_t>(at.x * map.width), map.width - 1);
        const auto row = std::min(static_cast<std::uint32_t>(at.y * map.height), map.height - 1);
        map.actuator[std::size_t{row} * map.width + column] =
            static_cast<std::uint16_t>(nearest - located.distance_m().begin() + 1);
      }
    }
  }
  return map;
}

void print(const char* map, const std::vector<Scores>& scores) {
  for (std::size_t k = 0; k < metrics().size(); ++k)
    std::printf("%s %-30s %10.4f %10.4f\n", map, metrics()[k].name, scores[0][k], scores[1][k]);
}

TEST(SlideScenario, IsASlideOfManyContacts) {
  EXPECT_GT(slide().contacts.size(), 1000U);
}

TEST(SlideScenario, UnderPhantomIsFeltAtMostHalfAsFarOffAsUnderBinaryByTwentyActuators) {
  const std::vector<Scores> scores = judge(front_of_twenty());
  print("20", scores);
  EXPECT_GT(metric(scores[0], "coverage"), 0.9);
  EXPECT_LE(metric(scores[1], "localisation_error_mm"), 0.5 * metric(scores[0], "localisation_error_mm"));
  EXPECT_LT(metric(scores[1], "slide_jump_mm"), 0.5 * metric(scores[0], "slide_jump_mm"));
}

TEST(SlideScenario, UnderPhantomIsFeltNearerThanUnderBinaryByThePapersSix) {
  const std::vector<Scores> scores = judge(test::builtin_map());
  print("6", scores);
  EXPECT_LT(metric(scores[1], "localisation_error_mm"), metric(scores[0], "localisation_error_mm"));
}

}  // namespace
}  // namespace vestige
