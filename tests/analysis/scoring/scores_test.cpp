// Whole recordings on a flat body, where every number can be found on paper.

#include "analysis/scoring/scores.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "detector/actuators/actuator_model.hpp"
#include "tests/support/flat_body.hpp"
#include "tests/support/mapping_run.hpp"
#include "traces/base/error.hpp"

namespace vestige {
namespace {

using test::metric;

constexpr int kCells = 16;
constexpr double kApart_m = 0.5;

/// Two actuators half a metre apart.
const ActuatorLayout& two() {
  static const ActuatorLayout layout(test::flat_body(kCells), test::nearest_map({{0.25, 0.5}, {0.75, 0.5}}, 256));
  return layout;
}

/// One collider that goes evenly from one actuator to the other, a contact in each of `frames` frames of 1 ms.
ContactRecording slide(int frames) {
  ContactRecording recording;
  for (int k = 0; k < frames; ++k) {
    const double share = (k + 0.5) / frames;
    recording.add(0.001 * k, ContactRow{test::contact_at(0.25 + kApart_m * share, 0.5, kCells)});
  }
  return recording;
}

Scores score_of(const ContactRecording& recording, const ActuatorLayout& layout, const std::string& law,
                double hold_s = 0.060, std::shared_ptr<const ActuatorModel> actuators = nullptr) {
  LawChoice choice;
  choice.name = law;
  choice.options.hold_s = hold_s;
  choice.actuators = std::move(actuators);
  return score(recording, {&layout}, choice);
}

TEST(Scores, OfASlideBetweenTwoActuatorsAreTheAnalyticOnes) {
  const ContactRecording recording = slide(4000);
  const Scores binary = score_of(recording, two(), "binary");
  const Scores phantom = score_of(recording, two(), "phantom");
  const Scores linear = score_of(recording, two(), "linear");
  // Root of 1/12; of the integral of (sqrt(b) / (sqrt(b) + sqrt(1 - b)) - b)²; and nothing.
  EXPECT_NEAR(metric(binary, "localisation_error_mm") / (1e3 * kApart_m), 0.2887, 2e-4);
  EXPECT_NEAR(metric(phantom, "localisation_error_mm") / (1e3 * kApart_m), 0.107, 5e-4);
  EXPECT_NEAR(metric(linear, "localisation_error_mm"), 0, 0.01);
  EXPECT_NEAR(metric(phantom, "energy_localisation_error_mm"), 0, 0.01);
  EXPECT_NEAR(metric(phantom, "slide_ripple"), 0, 1e-9);
  EXPECT_NEAR(metric(linear, "slide_ripple"), 0.75, 1e-3);
  EXPECT_NEAR(metric(binary, "slide_ripple"), 0, 1e-12);
  EXPECT_NEAR(metric(binary, "slide_jump_mm"), 1e3 * kApart_m, 1e-3);
  EXPECT_NEAR(metric(linear, "slide_jump_mm"), 1e3 * kApart_m / 4000, 0.01);
  EXPECT_LT(metric(phantom, "slide_jump_mm"), 10);
  for (const Scores& scores : {binary, phantom, linear}) {
    EXPECT_EQ(metric(scores, "coverage"), 1);
    EXPECT_EQ(metric(scores, "slide_reversals_per_m"), 0);
    EXPECT_NEAR(metric(scores, "mapped_area_m2"), 1, 1e-6);
    EXPECT_NEAR(metric(scores, "area_ratio"), 1, 1e-6);
  }
}

TEST(Scores, MeasureTheErrorAgainstWhereAMapMeansAContactToBeFelt) {
  const auto fires = [](const char* json) {
    ActuatorMap map = test::nearest_map({{0.25, 0.5}, {0.75, 0.5}}, 256);
    map.firing = Firing(nlohmann::json::parse(json), map.names, "map");
    return ActuatorLayout(test::flat_body(kCells), std::move(map));
  };
  const ContactRecording recording = slide(1000);
  const ActuatorLayout crossed = fires(R"({"1": {"2": 1}, "2": {"1": 1}})");
  for (const char* law : {"binary", "phantom", "gaussian"}) {
    const Scores own = score_of(recording, two(), law);
    const Scores elsewhere = score_of(recording, crossed, law);
    // Each actuator stands for the other's place, so that nothing is lost.
    for (const char* name : {"coverage", "localisation_error_mm", "information_bits", "use_evenness", "peak_duty"})
      EXPECT_NEAR(metric(elsewhere, name), metric(own, name), 1e-12) << law << ", " << name;
  }
  // Both fire the same: the error stays, but nobody can tell the two apart.
  const Scores together = score_of(recording, fires(R"({"1": {"2": 1}})"), "binary");
  EXPECT_NEAR(metric(together, "localisation_error_mm"),
              metric(score_of(recording, two(), "binary"), "localisation_error_mm"), 1e-12);
  EXPECT_EQ(metric(together, "information_bits"), 0);
  EXPECT_EQ(metric(score_of(recording, fires(R"({"1": {"2": 0.9}})"), "binary"), "information_bits"), 0);
  // Where both regions share one actuator, phantom has nothing to put between them.
  EXPECT_NEAR(metric(score_of(recording, fires(R"({"1": {"2": 1}})"), "phantom"), "localisation_error_mm"),
              metric(together, "localisation_error_mm"), 1e-9);
  // Less than half a step of the duty does not vibrate.
  EXPECT_EQ(metric(score_of(recording, fires(R"({"1": {"1": 0.001}, "2": {"2": 0.001}})"), "binary"), "coverage"), 0);
  EXPECT_EQ(metric(together, "use_evenness"), 0);
  // One region fires nothing: half of the contacts are not felt.
  const Scores half = score_of(recording, fires(R"({"1": {}})"), "binary");
  EXPECT_NEAR(metric(half, "coverage"), 0.5, 1e-3);
  EXPECT_NEAR(metric(score_of(recording, fires(R"({"1": {"1": 0.5}, "2": {"2": 0.5}})"), "binary", 0), "peak_duty"),
              0.25, 1e-12);
}

TEST(Scores, AreTheSameWhicheverWayTheBodyFaces) {
  const ContactRecording recording = slide(100);
  const double acuities = metric(score_of(recording, two(), "binary"), "localisation_error_acuities");
  for (const Facing facing : {Facing::kPlusX, Facing::kMinusZ, Facing::kMinusX}) {
    Avatar avatar = test::flat_body(kCells);
    for (glm::vec3& position : avatar.position_bind) position = turned_from_front(position, facing);
    set_facing(avatar.facing, facing, AvatarFacing::By::kAsked);
    ActuatorMap map = test::nearest_map({{0.25, 0.5}, {0.75, 0.5}}, 256);
    for (auto& position_m : map.position_m) position_m = turned_from_front(*position_m, facing);
    const ActuatorLayout layout(avatar, map);
    EXPECT_NEAR(metric(score_of(recording, layout, "binary"), "localisation_error_acuities"), acuities, 1e-9)
        << to_string(facing);
  }
}

TEST(Scores, OfAPerfectMappingOfEvenRegionsAreLog2OfTheirNumber) {
  std::vector<glm::dvec2> places;
  for (int i = 0; i < 8; ++i) places.emplace_back(0.125 + 0.25 * (i % 4), 0.25 + 0.5 * (i / 4));
  const ActuatorLayout layout(test::flat_body(kCells), test::nearest_map(places, 256));
  ContactRecording recording;
  for (int k = 0; k < 800; ++k) {
    const glm::dvec2& place = places[static_cast<std::size_t>(k) % 8];
    recording.add(0.01 * k, ContactRow{test::contact_at(place.x + 0.001 * (k % 7), place.y, kCells)});
  }
  const Scores scores = score_of(recording, layout, "binary", 0);
  EXPECT_NEAR(metric(scores, "information_bits"), 3, 1e-9);
  EXPECT_NEAR(metric(scores, "information_categories"), 8, 1e-8);
  EXPECT_NEAR(metric(scores, "use_evenness"), 1, 1e-12);
  EXPECT_NEAR(metric(scores, "mean_duty"), 1.0 / 8, 1e-12);
  EXPECT_NEAR(metric(scores, "peak_duty"), 1.0 / 8, 1e-12);
  EXPECT_NEAR(metric(scores, "switches_hz"), 800 / 8.0 / 8.0, 1e-6);
  EXPECT_EQ(metric(scores, "timing_f1"), 1);
  // A colliders' way of leaps is no slide.
  EXPECT_TRUE(std::isnan(metric(scores, "slide_ripple")));
}

TEST(Scores, CountContactOnSkinWithoutActuatorAsUnfeltAndSayWhere) {
  const ActuatorLayout layout(test::flat_body(kCells), test::nearest_map({{0.25, 0.5}, {0.75, 0.5}}, 256, 0.1));
  ContactRecording recording;
  for (int k = 0; k < 10; ++k) recording.add(0.1 * k, ContactRow{test::contact_at(k < 4 ? 0.30 : 0.5, 0.5, kCells)});
  for (const char* law : {"binary", "phantom", "gaussian"}) {
    const Scores scores = score_of(recording, layout, law, 0);
    EXPECT_DOUBLE_EQ(metric(scores, "coverage"), 0.4) << law;
    // Four right, six missed.
    if (std::string(law) == "binary") {
      EXPECT_DOUBLE_EQ(metric(scores, "timing_f1"), 8.0 / 14);
    }
  }
  const std::vector<float> errors = contact_errors_mm(recording, {&layout}, LawChoice());
  ASSERT_EQ(errors.size(), 10U);
  EXPECT_NEAR(errors[0], 50, 0.01);
  EXPECT_TRUE(std::isnan(errors[9]));
}

TEST(Scores, CompareErrorsOverTheContactsThatAllLetFeel) {
  // Skin near its actuators only: half of the contacts are felt, and those have small errors.
  const auto wide =
      std::make_shared<ActuatorLayout>(test::flat_body(kCells), test::nearest_map({{0.25, 0.5}, {0.75, 0.5}}, 256));
  const auto narrow = std::make_shared<ActuatorLayout>(test::flat_body(kCells),
                                                       test::nearest_map({{0.25, 0.5}, {0.75, 0.5}}, 256, 0.1));
  ContactRecording recording;
  for (int k = 0; k < 10; ++k)
    recording.add(0.1 * k, ContactRow{test::contact_at(k % 2 == 0 ? 0.3 : 0.5, 0.5, kCells)});
  LawChoice binary;
  binary.unfelt_m = 0.5;
  const std::vector<ScoredLayout> layouts = {{wide.get()}, {narrow.get()}};
  const std::vector<Scores> scores = score_all(recording, layouts, {&binary, 1});
  EXPECT_NEAR(metric(scores[0], "localisation_error_mm"), std::sqrt((50.0 * 50 + 250 * 250) / 2), 0.1);
  EXPECT_NEAR(metric(scores[1], "localisation_error_mm"), 50, 0.01);
  EXPECT_NEAR(metric(scores[0], "common_error_mm"), 50, 0.01);
  EXPECT_NEAR(metric(scores[1], "common_error_mm"), 50, 0.01);
  EXPECT_NEAR(metric(scores[0], "error_with_unfelt_mm"), metric(scores[0], "localisation_error_mm"), 1e-9);
  EXPECT_NEAR(metric(scores[1], "error_with_unfelt_mm"), std::sqrt((50.0 * 50 + 500 * 500) / 2), 0.1);
  // By itself, a map has its own contacts in common; and without a weight, what is not felt has no error.
  const Scores alone = score_of(recording, *wide, "binary");
  EXPECT_NEAR(metric(alone, "common_error_mm"), metric(alone, "localisation_error_mm"), 1e-4);
  EXPECT_TRUE(std::isnan(metric(alone, "error_with_unfelt_mm")));
}

TEST(Scores, PayForAHoldInTimeAndF1) {
  ContactRecording recording;
  for (int k = 0; k < 100; ++k) {
    Contact contact = test::contact_at(0.3, 0.5, kCells);
    contact.t = 0.25F;
    recording.add(0.01 * k, k % 50 == 10 ? ContactRow{contact} : ContactRow(1));
  }
  const Scores raw = score_of(recording, two(), "binary", 0);
  const Scores held = score_of(recording, two(), "binary", 0.040);
  EXPECT_EQ(metric(raw, "timing_f1"), 1);
  EXPECT_NEAR(metric(raw, "onset_error_ms"), 7.5, 1e-6);  // from a quarter of the frame to its end
  EXPECT_NEAR(metric(raw, "offset_error_ms"), 17.5, 1e-6);
  EXPECT_EQ(metric(raw, "onset_over_15ms"), 0);
  EXPECT_NEAR(metric(held, "offset_error_ms"), 47.5, 1e-6);
  // A contact of one frame in four on: 2 / (1 + 4).
  EXPECT_DOUBLE_EQ(metric(held, "timing_f1"), 0.4);
  EXPECT_NEAR(metric(held, "mean_duty"), 2 * 4 / 200.0, 1e-12);
}

TEST(Scores, WithMotorsAreLateAndMissWhatIsTooShort) {
  const auto model = std::make_shared<ActuatorModel>(
      parse_actuator_model(R"({"rise_ms": 60, "fall_ms": 60, "felt_threshold": 0.5})", "motor.json"));
  ContactRecording recording;
  for (int k = 0; k < 200; ++k)
    recording.add(0.01 * k, k >= 50 && k < 100 ? ContactRow{test::contact_at(0.3, 0.5, kCells)} : ContactRow(1));
  const Scores slow = score_of(recording, two(), "binary", 0.060, model);
  // To a half in 60 ms ln 2 after it is told, which is at the end of the first frame, the contact's instant (t = 1).
  EXPECT_NEAR(metric(slow, "onset_error_ms"), 60 * std::log(2), 1e-6);
  EXPECT_EQ(metric(slow, "onset_over_15ms"), 1);
  EXPECT_EQ(metric(slow, "onset_over_45ms"), 0);
  EXPECT_NEAR(metric(slow, "offset_error_ms"), 60 + 60 * std::log(2), 0.05);
  EXPECT_EQ(metric(slow, "coverage"), 1);  // 60 ms come to 0.63
  const Scores brief = score_of(recording, two(), "binary", 0.030, model);
  EXPECT_EQ(metric(brief, "coverage"), 0);  // 30 ms to 0.39, if it were alone
  EXPECT_LT(metric(slow, "timing_f1"), metric(score_of(recording, two(), "binary"), "timing_f1") + 0.2);
}

TEST(Scores, DoNotDependOnTheFrameRateOfMotors) {
  // A second of touch, a second without, at 20 and at 1000 frames a second.
  const auto onset_ms = [&](int rate_hz) {
    const auto model = std::make_shared<ActuatorModel>(Motor{.rise_s = 0.1, .felt_threshold = 0.3});
    ContactRecording recording;
    for (int k = 0; k < 2 * rate_hz; ++k) {
      Contact contact = test::contact_at(0.3, 0.5, kCells);
      recording.add(static_cast<double>(k) / rate_hz, k < rate_hz ? ContactRow{contact} : ContactRow(1));
    }
    return metric(score_of(recording, two(), "binary", 0.060, model), "onset_error_ms");
  };
  EXPECT_NEAR(onset_ms(20), onset_ms(1000), 1e-9);
}

TEST(Scores, AreTheSameTogetherAsOneByOne) {
  const ContactRecording recording = slide(300);
  const std::vector<std::string> names = law_names();
  std::vector<LawChoice> laws(names.size());
  for (std::size_t i = 0; i < names.size(); ++i) laws[i].name = names[i];
  const std::vector<Scores> together = score_all(recording, {&two()}, laws);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const Scores alone = score(recording, {&two()}, laws[i]);
    for (std::size_t k = 0; k < alone.size(); ++k) {
      if (metrics()[k].name == std::string_view("common_error_mm")) continue;  // depends on what is compared
      EXPECT_TRUE(alone[k] == together[i][k] || (std::isnan(alone[k]) && std::isnan(together[i][k])))
          << names[i] << ' ' << metrics()[k].name;
    }
  }
}

TEST(Scores, OfNothingAreUndefinedAndNothingFails) {
  const ActuatorLayout none(test::flat_body(2), ActuatorMap());
  ContactRecording quiet;
  for (int k = 0; k < 10; ++k) quiet.add(0.1 * k, ContactRow(3));
  for (const ContactRecording& recording : {ContactRecording(), quiet, slide(5)}) {
    for (const char* law : {"binary", "speed", "phantom", "gaussian"}) {
      EXPECT_EQ(score_of(recording, none, law).size(), metrics().size());
      const Scores scores = score_of(recording, two(), law);
      if (recording.contacts.empty()) {
        EXPECT_TRUE(std::isnan(metric(scores, "coverage")));
        EXPECT_TRUE(std::isnan(metric(scores, "localisation_error_mm")));
        EXPECT_TRUE(std::isnan(metric(scores, "information_bits")));
      }
    }
  }
  EXPECT_THROW(score_of(quiet, two(), "sine"), UsageError);
}

TEST(Scores, AreEachNamedOnceWithAFormulaAndASource) {
  std::set<std::string> names;
  for (const Metric& one : metrics()) {
    EXPECT_TRUE(names.insert(one.name).second) << one.name;
    EXPECT_GT(std::string(one.formula).size(), 10U) << one.name;
    EXPECT_NE(std::string(one.source), "") << one.name;
  }
  EXPECT_EQ(score_of(slide(5), two(), "binary").size(), metrics().size());
}

}  // namespace
}  // namespace vestige
