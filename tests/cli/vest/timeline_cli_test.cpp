// Timelines of real replays, read back as another program reads them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/command_line.hpp"
#include "tests/support/timeline_files.hpp"

namespace vestige {
namespace {

using ::testing::AllOf;
using ::testing::Each;
using ::testing::HasSubstr;

class Timelines : public test::CommandLineTest {
 protected:
  /// Replays a trace into each of the three kinds of timeline.
  void replay_into_all(const std::string& flags = "") {
    for (const char* end : {"csv", "hjif", "tact"}) {
      const test::Outcome outcome = run(std::string("vestige replay t.mcap --timeline t.") + end + " " + flags);
      ASSERT_EQ(outcome.exit_code, 0) << outcome.standard_error;
    }
    frames_ = test::read_timeline_csv(read_text_file(folder_ / "t.csv"));
    hjif_ = json_in("t.hjif");
    tact_ = json_in("t.tact");
  }

  void expect_that_all_agree() const {
    ASSERT_FALSE(frames_.empty());
    const double start_s = frames_[0].time_s;
    const auto& channels = hjif_["perceptions"][0]["channels"];
    ASSERT_EQ(channels.size(), frames_[0].duty.size());
    for (const ActuatorFrame& frame : frames_)
      for (std::size_t i = 0; i < frame.duty.size(); ++i)
        ASSERT_NEAR(test::hjif_duty(hjif_, i, std::round((frame.time_s - start_s) * 1e3)), frame.duty[i], 1e-9)
            << frame.time_s << " s, actuator " << i + 1;

    const auto& feedback = tact_["feedback"];
    ASSERT_EQ(tact_["durationMillis"], 20 * static_cast<int>(feedback.size()));
    ASSERT_GT(tact_["durationMillis"].get<double>(), 1e3 * (frames_.back().time_s - start_s));
    for (const auto& [time_ms, sides] : feedback.items()) {
      ASSERT_EQ(sides.size(), 1U);
      EXPECT_EQ(sides[0]["position"], "VestFront");
      for (std::size_t i = 0; i < 20; ++i)
        ASSERT_EQ(sides[0]["values"].at(i),
                  i < channels.size() ? test::expected_percent(frames_, i, std::stol(time_ms)) : 0)
            << time_ms << " ms, actuator " << i + 1;
    }
  }

  bool any_on() const {
    return std::ranges::any_of(frames_, [](const ActuatorFrame& frame) {
      return std::ranges::any_of(frame.duty, [](std::uint8_t duty) { return duty != 0; });
    });
  }

  std::vector<ActuatorFrame> frames_;
  nlohmann::json hjif_;
  nlohmann::json tact_;
};

TEST_F(Timelines, OfOneReplayAgreeWhateverTheirKind) {
  for (const char* rate : {"60", "1000"}) {
    ASSERT_EQ(run(std::string("vestige record --force --count 20 --duration 1 -o t.mcap --rate ") + rate).exit_code, 0);
    replay_into_all("--force --hold 5");
    EXPECT_TRUE(any_on());
    expect_that_all_agree();
  }
  EXPECT_EQ(hjif_["perceptions"][0]["channels"].size(), 6U);
  EXPECT_EQ(tact_["name"], "t");
  const auto replay = json_of("vestige replay t.mcap --json -");
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_EQ(hjif_["perceptions"][0]["channels"][i]["description"], replay["actuators"][i]["name"]);
}

TEST_F(Timelines, AreValidMpegHaptics) {
  VESTIGE_REQUIRE_DATA(test::data("hjif"));
  ASSERT_EQ(run("vestige record --count 20 --rate 60 --duration 1 -o t.mcap").exit_code, 0);
  replay_into_all();
  EXPECT_EQ(test::hjif_complaints(folder_ / "t.hjif"), "");
}

TEST_F(Timelines, OfATraceWithoutContactAreCompleteAndOff) {
  ASSERT_EQ(run("printf 'time_s,id,x,y,z\n0,0,50,50,50\n1,0,50,51,50\n' >far.csv && "
                "vestige record --colliders far.csv --rate 60 --duration 1 -o t.mcap")
                .exit_code,
            0);
  replay_into_all();
  EXPECT_FALSE(any_on());
  expect_that_all_agree();
  EXPECT_THAT(tact_["feedback"]["0"][0]["values"].get<std::vector<int>>(), Each(0));
  VESTIGE_REQUIRE_DATA(test::data("hjif"));
  EXPECT_EQ(test::hjif_complaints(folder_ / "t.hjif"), "");
}

TEST_F(Timelines, OfATraceWithoutAMapAreRefused) {
  ASSERT_EQ(run("vestige record --map none --count 5 --rate 60 --duration 0.1 -o t.mcap").exit_code, 0);
  for (const char* name : {"t.hjif", "t.tact", "t.csv"}) {
    const test::Outcome outcome = run(std::string("vestige replay t.mcap --timeline ") + name);
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_THAT(outcome.standard_error, AllOf(HasSubstr("no actuator in t.mcap"), HasSubstr("--map")));
    EXPECT_FALSE(std::filesystem::exists(folder_ / name));
  }
}

TEST_F(Timelines, OfAnUnknownKindAreRefusedNamingTheKnownOnes) {
  ASSERT_EQ(run("vestige record --count 5 --rate 60 --duration 0.1 -o t.mcap").exit_code, 0);
  const test::Outcome outcome = run("vestige replay t.mcap --timeline t.wav --contacts c.csv");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.standard_error,
              AllOf(HasSubstr("t.wav"), HasSubstr(".csv"), HasSubstr(".hjif"), HasSubstr(".tact")));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "c.csv"));
}

}  // namespace
}  // namespace vestige
