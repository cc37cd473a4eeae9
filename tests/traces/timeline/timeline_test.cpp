#include "traces/timeline/timeline.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/test_data.hpp"
#include "tests/support/timeline_files.hpp"
#include "traces/base/error.hpp"
#include "traces/files/input_file.hpp"

namespace vestige {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;

class Timeline : public ::testing::Test {
 protected:
  nlohmann::json write(const char* name, const std::vector<ActuatorFrame>& frames,
                       const std::vector<std::string>& names) const {
    const auto file = make_timeline(folder_ / name, Overwrite::kRefuse, names);
    for (const ActuatorFrame& frame : frames) file->write(frame);
    file->commit();
    return nlohmann::json::parse(read_text_file(folder_ / name));
  }

  std::string refusal(const std::string& name, std::size_t actuators) const {
    try {
      make_timeline(folder_ / name, Overwrite::kRefuse, std::vector<std::string>(actuators, "a"));
    } catch (const UsageError& error) {
      return error.what();
    }
    return "";
  }

  static std::vector<std::pair<int, double>> keyframes_of(const nlohmann::json& hjif, std::size_t actuator) {
    std::vector<std::pair<int, double>> keyframes;
    for (const auto& keyframe : hjif["perceptions"][0]["channels"][actuator]["bands"][0]["effects"][0]["keyframes"])
      keyframes.emplace_back(keyframe["relative_position"], keyframe["amplitude_modulation"]);
    return keyframes;
  }

  static std::vector<std::vector<int>> values_of(const nlohmann::json& tact, const char* time_ms) {
    std::vector<std::vector<int>> values;
    for (const auto& side : tact.at("feedback").at(time_ms)) values.push_back(side["values"]);
    return values;
  }

  const test::TemporaryFolder folder_;
};

TEST_F(Timeline, HjifStepsWithinTheMillisecondBeforeAChangeAndLastsUntilTheLastFrame) {
  const auto hjif =
      write("a.hjif", {{7, {0, 51}}, {7.01, {255, 51}}, {7.02, {255, 51}}, {7.03, {0, 51}}, {7.04, {0, 51}}},
            {"chest", "back"});
  EXPECT_THAT(keyframes_of(hjif, 0), ElementsAre(std::pair(0, 0.0), std::pair(9, 0.0), std::pair(10, 1.0),
                                                 std::pair(29, 1.0), std::pair(30, 0.0), std::pair(40, 0.0)));
  EXPECT_THAT(keyframes_of(hjif, 1), ElementsAre(std::pair(0, 0.2), std::pair(40, 0.2)));
  EXPECT_EQ(hjif["perceptions"][0]["channels"][1]["description"], "back");
  EXPECT_THAT(hjif["date"].get<std::string>(), MatchesRegex("20[0-9][0-9]-[01][0-9]-[0-3][0-9]T[0-9:]{8}Z"));
  EXPECT_EQ(hjif["timescale"], 1000);
}

TEST_F(Timeline, HjifHasEveryFramesDutyAtAThousandFramesASecond) {
  std::vector<ActuatorFrame> frames;
  for (int k = 0; k < 256; ++k)
    frames.push_back({k / 1000.0, {static_cast<std::uint8_t>(k), static_cast<std::uint8_t>(k % 3 == 0 ? 255 : 0)}});
  const auto hjif = write("a.hjif", frames, {"rising", "flickering"});
  for (int k = 0; k < 256; ++k)
    for (std::size_t i = 0; i < 2; ++i)
      EXPECT_EQ(std::lround(test::hjif_duty(hjif, i, k)), frames[static_cast<std::size_t>(k)].duty[i]) << k;
}

TEST_F(Timeline, HjifLosesNoContactOfFramesWithinOneMillisecond) {
  const auto hjif = write("a.hjif", {{0, {0}}, {0.0051, {255}}, {0.0052, {0}}, {0.0053, {0}}, {0.006, {0}}}, {"a"});
  EXPECT_EQ(test::hjif_duty(hjif, 0, 4), 0);
  EXPECT_EQ(test::hjif_duty(hjif, 0, 5), 255);
  EXPECT_EQ(test::hjif_duty(hjif, 0, 6), 0);
}

TEST_F(Timeline, HjifIsValidWithAndWithoutFramesAndWithNamesThatAreNoText) {
  VESTIGE_REQUIRE_DATA(test::data("hjif"));
  write("a.hjif", {{0, {0, 0}}, {1, {3, 255}}}, {"\"quoted\"", "\xff\xfe"});
  EXPECT_EQ(test::hjif_complaints(folder_ / "a.hjif"), "");
  write("none.hjif", {}, {"a"});
  EXPECT_EQ(test::hjif_complaints(folder_ / "none.hjif"), "");
}

TEST_F(Timeline, TactHoldsTheLargestDutyOfEveryTwentyMilliseconds) {
  const auto tact =
      write("punch.tact", {{7, {0}}, {7.005, {51}}, {7.010, {0}}, {7.030, {255}}, {7.070, {0}}, {7.1, {128}}}, {"a"});
  EXPECT_EQ(tact["intervalMillis"], 20);
  EXPECT_EQ(tact["size"], 20);
  EXPECT_EQ(tact["name"], "punch");
  EXPECT_EQ(tact["durationMillis"], 120);
  std::vector<int> first;
  for (const char* time_ms : {"0", "20", "40", "60", "80", "100"}) {
    const auto values = values_of(tact, time_ms);
    ASSERT_EQ(values.size(), 1U);
    ASSERT_EQ(values[0].size(), 20U);
    first.push_back(values[0][0]);
  }
  // On from 30 to 70 ms, which is in three of the intervals, and without a frame of its own in one of them.
  EXPECT_THAT(first, ElementsAre(20, 100, 100, 100, 0, 50));
  EXPECT_EQ(tact["feedback"].size(), 6U);
  EXPECT_EQ(tact["feedback"]["0"][0]["mode"], "DOT_MODE");
  EXPECT_EQ(tact["feedback"]["0"][0]["texture"], 0);
}

TEST_F(Timeline, TactPutsTheFirstTwentyActuatorsInFrontAndTheOthersOnTheBack) {
  ActuatorFrame frame{0, std::vector<std::uint8_t>(22)};
  frame.duty[19] = 255;
  frame.duty[20] = 255;
  const auto tact = write("a.tact", {frame}, std::vector<std::string>(22, "a"));
  EXPECT_EQ(tact["feedback"]["0"][0]["position"], "VestFront");
  EXPECT_EQ(tact["feedback"]["0"][1]["position"], "VestBack");
  EXPECT_EQ(values_of(tact, "0")[0][19], 100);
  EXPECT_EQ(values_of(tact, "0")[1][0], 100);
  EXPECT_EQ(values_of(tact, "0")[1][1], 0);
}

TEST_F(Timeline, TactRefusesAGapOfDaysBeforeItFillsTheDisk) {
  const auto file = make_timeline(folder_ / "a.tact", Overwrite::kRefuse, {"a"});
  file->write({0, {0}});
  EXPECT_THROW(file->write({1e9, {0}}), Error);
}

TEST_F(Timeline, WhatAFormatCannotHoldIsRefusedWithARemedy) {
  EXPECT_THAT(refusal("a.txt", 6), ::testing::AllOf(HasSubstr(".csv"), HasSubstr(".hjif"), HasSubstr(".tact")));
  EXPECT_THAT(refusal("a.tact", 41), ::testing::AllOf(HasSubstr("41 actuators"), HasSubstr("has 40")));
  EXPECT_THAT(refusal("a.tact", 0), HasSubstr("--map"));
  EXPECT_THAT(refusal("a.hjif", 0), HasSubstr("--map"));
  EXPECT_EQ(refusal("a.csv", 0), "");
  EXPECT_EQ(refusal("a.tact", 40), "");
}

TEST_F(Timeline, LeavesNothingBehindWithoutCommit) {
  for (const char* name : {"a.csv", "a.hjif", "a.tact"})
    make_timeline(folder_ / name, Overwrite::kRefuse, {"a"})->write({0, {255}});
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

TEST_F(Timeline, ADeviceOrAPipeIsWrittenAsCsv) {
  EXPECT_NO_THROW(make_timeline("/dev/null", Overwrite::kRefuse, {"a"})->commit());
}

}  // namespace
}  // namespace vestige
