// Intensity laws, motors and maps that change on the way, as a user asks for them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "tests/support/command_line.hpp"
#include "tests/support/timeline_files.hpp"
#include "traces/files/input_file.hpp"
#include "traces/scene/builtin_avatar.hpp"

namespace vestige {
namespace {

using ::testing::ElementsAreArray;
using ::testing::HasSubstr;
using ::testing::Not;

class Laws : public test::CommandLineTest {
 protected:
  void SetUp() override {
    ASSERT_EQ(run("vestige record -q --colliders slide --rate 120 --duration 2 -o t.mcap").exit_code, 0);
  }

  std::vector<ActuatorFrame> timeline(const std::string& flags) const {
    const test::Outcome outcome = run("vestige replay t.mcap --force --timeline t.csv " + flags);
    EXPECT_EQ(outcome.exit_code, 0) << flags << "\n" << outcome.standard_error;
    return test::read_timeline_csv(read_text_file(folder_ / "t.csv"));
  }

  /// The built-in map under another name, its actuators numbered the other way round.
  void write_turned_map(const std::string& name) const {
    const std::vector<std::byte> png = builtin_actuator_map_png();
    std::ofstream(folder_ / (name + ".png"), std::ios::binary)
        .write(reinterpret_cast<const char*>(png.data()), static_cast<std::streamsize>(png.size()));
    auto json = nlohmann::json::parse(builtin_actuator_map_json());
    std::ranges::reverse(json["actuators"]);
    write(name + ".json", json.dump());
  }
};

/// How many different duties there are.
std::size_t levels_in(const std::vector<ActuatorFrame>& frames) {
  std::vector<bool> seen(256);
  for (const ActuatorFrame& frame : frames)
    for (const std::uint8_t duty : frame.duty) seen[duty] = true;
  return static_cast<std::size_t>(std::ranges::count(seen, true));
}

double sum(const std::vector<ActuatorFrame>& frames) {
  double all = 0;
  for (const ActuatorFrame& frame : frames)
    for (const std::uint8_t duty : frame.duty) all += duty;
  return all;
}

TEST_F(Laws, AreBinaryUnlessAskedOtherwise) {
  timeline("");
  const std::string plain = read_text_file(folder_ / "t.csv");
  timeline("--law binary");
  EXPECT_EQ(read_text_file(folder_ / "t.csv"), plain);
  EXPECT_EQ(levels_in(timeline("")), 2U);
}

TEST_F(Laws, GradeDutiesWithTheContact) {
  for (const char* law : {"speed", "phantom", "gaussian"}) {
    EXPECT_GT(levels_in(timeline(std::string("--law ") + law)), 10U) << law;
    const auto json = json_of(std::string("vestige replay t.mcap --timeline other.csv --force --json - --law ") + law);
    EXPECT_EQ(json["law"]["name"], law);
  }
  EXPECT_GT(json_of("vestige replay t.mcap --timeline o.csv --json - --law gaussian")["law"]["sigma_mm"], 10);
}

/// At the shoulder, the shortest way to an actuator flips from the front of the body to its back.
TEST_F(Laws, LetAHandThatStrokesAnArmBeFeltWithoutJumps) {
  ASSERT_EQ(
      run("vestige record -q --force --animation idle --colliders brush --count 1 --map body --duration 2.4 -o t.mcap")
          .exit_code,
      0);
  const std::vector<ActuatorFrame> frames = timeline("--law phantom --method ccd");
  const auto is_felt = [](const ActuatorFrame& frame) {
    return std::ranges::any_of(frame.duty, [](std::uint8_t duty) { return duty != 0; });
  };
  int felt = 0;
  for (std::size_t k = 1; k < frames.size(); ++k) {
    if (!is_felt(frames[k - 1]) || !is_felt(frames[k])) continue;  // where a touch begins and ends
    ++felt;
    for (std::size_t i = 0; i < frames[k].duty.size(); ++i)
      EXPECT_LE(std::abs(frames[k].duty[i] - frames[k - 1].duty[i]), 0.2 * 255)
          << "actuator " << i + 1 << " at " << frames[k].time_s << " s";
  }
  EXPECT_GT(felt, 1000);
}

TEST_F(Laws, TakeTheirParameters) {
  EXPECT_GT(sum(timeline("--law speed --full-speed 0.5")), sum(timeline("--law speed --full-speed 2")));
  EXPECT_GT(sum(timeline("--law gaussian --sigma 200")), sum(timeline("--law gaussian --sigma 50")));
  write("motor.json", R"({"duty": {"gamma": 0.5}})");
  EXPECT_GT(sum(timeline("--law gaussian --actuator motor.json")), sum(timeline("--law gaussian")));
}

TEST_F(Laws, KickAMotorThatStarts) {
  write("motor.json", R"({"kick_ms": 20})");
  const std::vector<ActuatorFrame> plain = timeline("--law speed --full-speed 5");
  const std::vector<ActuatorFrame> kicked = timeline("--law speed --full-speed 5 --actuator motor.json");
  ASSERT_EQ(plain.size(), kicked.size());
  bool any = false;
  for (std::size_t k = 1; k < plain.size(); ++k)
    for (std::size_t i = 0; i < 6; ++i)
      if (plain[k].duty[i] != 0 && plain[k - 1].duty[i] == 0) {
        EXPECT_EQ(kicked[k].duty[i], 255);
        any = true;
      }
  EXPECT_TRUE(any);
}

TEST_F(Laws, OfEveryKindOfTimelineAreTheSame) {
  const std::vector<ActuatorFrame> frames = timeline("--law phantom");
  ASSERT_EQ(run("vestige replay t.mcap --timeline t.hjif --law phantom").exit_code, 0);
  const auto hjif = nlohmann::json::parse(read_text_file(folder_ / "t.hjif"));
  for (const ActuatorFrame& frame : frames)
    for (std::size_t i = 0; i < 6; ++i)
      ASSERT_NEAR(test::hjif_duty(hjif, i, std::round(frame.time_s * 1e3)), frame.duty[i], 1e-9) << frame.time_s;
}

TEST_F(Laws, DriveAVestToo) {
  const auto json = json_of("vestige stream t.mcap --port file:frames --rate 10 --law phantom --log log.csv --json -");
  EXPECT_EQ(json["law"]["name"], "phantom");
  const std::string log = read_text_file(folder_ / "log.csv");
  // time_s,state,written_us,actuator_1,…
  std::set<std::string> levels;
  std::istringstream lines(log);
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    std::istringstream fields(line);
    std::string field;
    for (int column = 0; std::getline(fields, field, ','); ++column)
      if (column >= 3) levels.insert(field);
  }
  EXPECT_GT(levels.size(), 10U);
}

TEST_F(Laws, RefuseFlagsThatWouldDoNothing) {
  expect_failure("vestige replay t.mcap --law phantom", 2, {"--law", "--timeline"});
  expect_failure("vestige replay t.mcap --sigma 20", 2, {"--sigma", "--timeline"});
  expect_failure("vestige replay t.mcap --timeline a.csv --sigma 20", 2, {"--sigma", "binary", "--law gaussian"},
                 "a.csv");
  expect_failure("vestige replay t.mcap --timeline a.csv --law phantom --full-speed 2", 2,
                 {"--full-speed", "phantom", "--law speed"}, "a.csv");
  expect_failure("vestige replay t.mcap --timeline a.csv --law sine", 2, {"--law", "phantom"}, "a.csv");
  expect_failure("vestige replay t.mcap --timeline a.csv --law speed --full-speed 0", 2, {"--full-speed"}, "a.csv");
  expect_failure("vestige replay t.mcap --timeline a.csv --actuator no.json", 1, {"no.json"}, "a.csv");
  write("bad.json", R"({"rise": 3})");
  expect_failure("vestige replay t.mcap --timeline a.csv --actuator bad.json", 1, {"bad.json", "'rise'"}, "a.csv");
  expect_failure("vestige stream t.mcap --port file:f --levels pressure --law phantom", 2, {"--law", "speed"}, "f");
}

TEST_F(Laws, GoOnWithAnotherMapFromItsTime) {
  write_turned_map("turned");
  for (const char* law : {"binary --hold 0", "phantom --hold 0"}) {
    const std::string flags = std::string("--law ") + law;
    const std::vector<ActuatorFrame> plain = timeline(flags);
    const std::vector<ActuatorFrame> changed =
        timeline(flags + " --map-at 1=turned.png --map-at 1.5=builtin --threads 2");
    ASSERT_EQ(plain.size(), changed.size());
    for (std::size_t k = 0; k < plain.size(); ++k) {
      std::vector<std::uint8_t> expected = plain[k].duty;
      if (plain[k].time_s >= 1 && plain[k].time_s < 1.5) std::ranges::reverse(expected);
      ASSERT_THAT(changed[k].duty, ElementsAreArray(expected)) << law << ' ' << plain[k].time_s;
    }
  }
  // Whatever else says which actuator a contact has goes with it.
  const auto json = json_of("vestige replay t.mcap --json - --map-at 0=turned.png");
  const auto plain = json_of("vestige replay t.mcap --json -");
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_EQ(json["actuators"][i]["contacts"], plain["actuators"][5 - i]["contacts"]);
  EXPECT_NE(json["texture_hash"], plain["texture_hash"]);
  EXPECT_EQ(run("vestige replay t.mcap --map-at 1=turned.png --detector cpu --verify exact").exit_code, 0);
  const test::Outcome late = run("vestige replay t.mcap --map-at 1=turned.png --map-at 2000=builtin");
  EXPECT_EQ(late.exit_code, 0);
  EXPECT_THAT(late.standard_error, HasSubstr("--map-at 2000=builtin: the trace ends before that"));
  EXPECT_THAT(late.standard_error, Not(HasSubstr("turned.png")));
}

TEST_F(Laws, RefuseMapsThatCannotFollow) {
  write_turned_map("turned");
  const std::string replay = "vestige replay t.mcap --timeline a.csv ";
  expect_failure(replay + "--map-at turned.png", 2, {"--map-at", "turned.png", "2.5=other.png"}, "a.csv");
  expect_failure(replay + "--map-at soon=turned.png", 2, {"--map-at", "soon"}, "a.csv");
  expect_failure(replay + "--map-at 1=turned.png --map-at 1=builtin", 2, {"--map-at", "two maps"}, "a.csv");
  expect_failure(replay + "--map-at 1=turned.png --surface mapped", 2, {"--map-at", "--surface"}, "a.csv");
  expect_failure(replay + "--map-at 1=turned.png --detector paper", 2, {"--map-at", "paper"}, "a.csv");
  expect_failure(replay + "--map-at 1=none", 2, {"--map-at", "none"}, "a.csv");
  expect_failure(replay + "--map-at 1=no.png", 1, {"no.png"}, "a.csv");
  ASSERT_EQ(run("rm turned.json").exit_code, 0);
  write("turned.json", R"({"actuators": [{"grey": 40}, {"grey": 80}, {"grey": 120}, {"grey": 160}, {"grey": 200},
    {"grey": 240}, {"grey": 7}]})");
  expect_failure(replay + "--map-at 1=turned.png", 1, {"turned.png", "7 actuators", "6"}, "a.csv");
}

}  // namespace
}  // namespace vestige
