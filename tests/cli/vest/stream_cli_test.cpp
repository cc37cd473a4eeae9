// Streams traces as a user does, to a simulated board: the vest's own program on a simulated ATmega1280, behind a pty.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "tests/cli/vest/board_command_line.hpp"
#include "tests/support/duty_rows.hpp"

namespace vestige {
namespace {

using test::Levels;
using test::read_log;
using test::read_timeline;
using test::Row;
using ::testing::Each;
using ::testing::HasSubstr;

/// The rows whose levels are not those of the row before.
std::vector<Row> changes(const std::vector<Row>& rows) {
  std::vector<Row> changes;
  for (const Row& row : rows)
    if (changes.empty() || changes.back().level != row.level) changes.push_back(row);
  return changes;
}

/// What one motor did, one after the other, from off to off.
Levels steps_of(std::size_t motor, const std::vector<Row>& rows) {
  Levels steps = {0};
  for (const Row& row : rows)
    if (row.level.at(motor) != steps.back()) steps.push_back(row.level[motor]);
  if (steps.back() != 0) steps.push_back(0);
  return steps;
}

using StreamCommand = test::BoardCommandLine;

TEST_F(StreamCommand, WhatTheTimelineSaysHappensAtThePinsOfTheSimulatedBoard) {
  record("--count 60 --rate 500 --duration 3");
  ASSERT_EQ(run("vestige replay -q trace.mcap --timeline timeline.csv").exit_code, 0);
  const test::Outcome outcome =
      run_with_board("vestige stream trace.mcap --port vest --ttl 2000 --log log.csv --json stream.json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.standard_error;

  // Every change of the timeline was sent, or is said to have been superseded.
  const std::vector<Row> expected = changes(read_timeline(folder_ / "timeline.csv"));
  const std::vector<Row> log = read_log(folder_ / "log.csv");
  ASSERT_EQ(log.size(), expected.size());
  EXPECT_GT(log.size(), 20U);
  for (std::size_t i = 0; i < log.size(); ++i) {
    EXPECT_EQ(log[i].time_s, expected[i].time_s) << i;
    EXPECT_EQ(log[i].level, expected[i].level) << i;
  }

  // And what was sent is what the pins did, motor by motor, in order.
  std::vector<Row> sent = log;
  std::erase_if(sent, [](const Row& row) { return row.state != "sent"; });
  const std::vector<Row> pins = read_timeline(folder_ / "pins.csv");
  for (std::size_t motor = 0; motor < 6; ++motor) {
    const Levels commanded = steps_of(motor, sent);
    const Levels measured = steps_of(motor, pins);
    ASSERT_EQ(measured.size(), commanded.size()) << "motor " << motor + 1;
    for (std::size_t i = 0; i < measured.size(); ++i) EXPECT_NEAR(measured[i], commanded[i], 1) << motor << " " << i;
  }

  const nlohmann::json json = json_in("stream.json");
  EXPECT_EQ(json["frames"], 1500);
  EXPECT_EQ(json["acknowledged"], json["sent"]);
  EXPECT_EQ(json["changes"], sent.size());
  EXPECT_EQ(json["superseded"], log.size() - sent.size());
  EXPECT_TRUE(json["off_acknowledged"]);
  EXPECT_EQ(json["receive_errors"], 0);
  EXPECT_EQ(json["link"]["baud"], 57600);
  EXPECT_EQ(json["link"]["frame_bytes"], 14);
  EXPECT_EQ(json["link"]["board"]["actuators"], 6);
  for (const char* key : {"p50", "p95", "p99", "max"}) {
    EXPECT_GT(json["latency_us"]["written"][key], 0) << key;
    EXPECT_GE(json["latency_us"]["acknowledged"][key], json["latency_us"]["written"][key]) << key;
  }
  EXPECT_THAT(outcome.standard_output, HasSubstr("of them changes"));
}

/// A built-in layout, and the board that has enough channels for it.
struct LayoutOnChips {
  const char* layout;
  std::size_t motors;
  int chips;
  int floor_us;  ///< 5 ms, or a frame's time on the line
};

class StreamToChips : public test::BoardCommandLine, public ::testing::WithParamInterface<LayoutOnChips> {};

INSTANTIATE_TEST_SUITE_P(, StreamToChips,
                         ::testing::Values(LayoutOnChips{"torso16", 16, 1, 5000},
                                           LayoutOnChips{"torso40", 40, 3, 8334}),
                         [](const auto& test) { return std::string(test.param.layout); });

TEST_P(StreamToChips, WhatTheTimelineSaysHappensAtTheOutputsOfTheChips) {
  const LayoutOnChips& of = GetParam();
  const auto channels = static_cast<std::size_t>(16 * of.chips);
  ASSERT_EQ(run(std::string("vestige map make -q --layout ") + of.layout + " -o map.png").exit_code, 0);
  record("--map map.png --colliders hug --count 60 --rate 200 --duration 3");
  ASSERT_EQ(run("vestige replay -q trace.mcap --timeline timeline.csv").exit_code, 0);
  const test::Outcome outcome =
      run_with_board("vestige stream trace.mcap --port vest --ttl 2000 --log log.csv --json stream.json",
                     "vest-atmega1280-" + std::to_string(channels), of.chips);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.standard_error;

  const std::vector<Row> expected = changes(read_timeline(folder_ / "timeline.csv"));
  std::vector<Row> sent = read_log(folder_ / "log.csv");
  ASSERT_EQ(sent.size(), expected.size());
  EXPECT_GT(sent.size(), 20U);
  for (std::size_t i = 0; i < sent.size(); ++i) EXPECT_EQ(sent[i].level, expected[i].level) << i;
  std::erase_if(sent, [](const Row& row) { return row.state != "sent"; });
  const std::vector<Row> outputs = read_timeline(folder_ / "pins.csv");
  ASSERT_EQ(outputs.front().level.size(), channels);
  std::size_t moved = 0;
  for (std::size_t motor = 0; motor < channels; ++motor) {
    const Levels commanded = motor < of.motors ? steps_of(motor, sent) : Levels{0};
    EXPECT_EQ(steps_of(motor, outputs), commanded) << "motor " << motor + 1;
    if (commanded.size() > 1) ++moved;
  }
  EXPECT_GT(moved, of.motors / 2);

  const nlohmann::json json = json_in("stream.json");
  EXPECT_EQ(json["acknowledged"], json["sent"]);
  EXPECT_EQ(json["output_failures"], 0);
  EXPECT_EQ(json["floor_us"], of.floor_us);
  EXPECT_EQ(json["link"]["frame_bytes"], 8 + of.motors);
  EXPECT_EQ(json["link"]["board"]["actuators"], channels);
}

TEST_F(StreamCommand, ABoardWhoseChipsDoNotAnswerIsReported) {
  record("--count 60 --rate 200 --duration 1");
  const test::Outcome outcome = run_with_board(
      "vestige stream trace.mcap --port vest --json stream.json; streamed=$?\n"
      "vestige vest check --port vest --seconds 0.05 --json check.json; echo $streamed $?; true",
      "vest-atmega1280-32", 1);
  EXPECT_THAT(outcome.standard_output, HasSubstr("3 4\n"));
  EXPECT_THAT(outcome.standard_error, HasSubstr("the board's output chips do not answer it"));
  EXPECT_THAT(outcome.standard_error, HasSubstr("the board's output chips did not answer it, by"));
  EXPECT_THAT(outcome.standard_output, HasSubstr("say that its output chips do not answer it"));
  EXPECT_GT(json_in("stream.json")["output_failures"], 0);
  EXPECT_GT(json_in("check.json")["output_failures"], 0);
  EXPECT_FALSE(json_in("check.json")["good"]);
  for (const Row& row : read_timeline(folder_ / "pins.csv")) EXPECT_THAT(row.level, Each(0));
}

TEST_F(StreamCommand, EachOfTwoPeopleFeelsTheirOwnTimelineOnTheirOwnBoard) {
  record(
      "--avatar builtin --name ann --colliders hug --count 60 --rate 500 --duration 2 --avatar builtin --name bob "
      "--animation none --at 0,0,3,180");
  ASSERT_EQ(run("vestige replay -q trace.mcap --timeline timeline.csv").exit_code, 0);
  const test::Outcome outcome = run_with_two_boards(
      "vestige stream trace.mcap --port 2=vest2 --port 1=vest --ttl 2000 --log log.csv --json stream.json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.standard_error;
  EXPECT_THAT(outcome.standard_output, ::testing::AllOf(HasSubstr("ann: "), HasSubstr("bob: ")));
  const nlohmann::json json = json_in("stream.json");
  std::vector<std::vector<Row>> logs;
  for (const auto& [number, place] : {std::pair("", 0), std::pair("2", 1)}) {
    const std::string suffix = place == 0 ? "" : ".2";
    std::vector<Row> log = read_log(folder_ / ("log" + suffix + ".csv"));
    const std::vector<Row> expected = changes(read_timeline(folder_ / ("timeline" + suffix + ".csv")));
    ASSERT_EQ(log.size(), expected.size());
    EXPECT_GT(log.size(), 5U);
    for (std::size_t i = 0; i < log.size(); ++i) EXPECT_EQ(log[i].level, expected[i].level) << place << " " << i;
    logs.push_back(log);
    std::erase_if(log, [](const Row& row) { return row.state != "sent"; });
    const std::vector<Row> pins = read_timeline(folder_ / ("pins" + std::string(number) + ".csv"));
    for (std::size_t motor = 0; motor < 6; ++motor)
      EXPECT_EQ(steps_of(motor, pins).size(), steps_of(motor, log).size()) << place << ", motor " << motor + 1;
    const nlohmann::json& person = json["avatars"][static_cast<std::size_t>(place)];
    EXPECT_EQ(person["name"], place == 0 ? "ann" : "bob");
    EXPECT_EQ(person["link"]["port"], "vest" + std::string(number));
    EXPECT_EQ(person["changes"], log.size());
    EXPECT_TRUE(person["off_acknowledged"]);
  }
  EXPECT_NE(logs[0].size(), logs[1].size()) << "both felt the same";
  for (const char* count : {"contacts", "sent", "changes", "acknowledged"})
    EXPECT_EQ(json[count], json["avatars"][0][count].get<int>() + json["avatars"][1][count].get<int>()) << count;
}

TEST_F(StreamCommand, NothingIsLostInSilenceWhenEveryProcessorIsBusy) {
  record("--count 60 --rate 500 --duration 3");
  const test::Outcome outcome = run_with_board(
      "neighbours=; for i in $(seq $(nproc)); do (while :; do :; done) & neighbours=\"$neighbours $!\"; done\n"
      "vestige stream trace.mcap --port vest --ttl 2000 --log log.csv --json stream.json; busy=$?\n"
      "kill $neighbours; (exit $busy)");
  const nlohmann::json json = json_in("stream.json");
  // Every state is in the log: it was sent, or a newer one took its place.
  const std::vector<Row> log = read_log(folder_ / "log.csv");
  const auto sent = std::ranges::count(log, "sent", &Row::state);
  EXPECT_EQ(json["changes"], sent);
  EXPECT_EQ(json["superseded"], log.size() - static_cast<std::size_t>(sent));
  // Every frame was acknowledged, or it is said that it was not.
  const bool all_heard = json["acknowledged"] == json["sent"];
  const bool is_said = outcome.standard_error.find("were not acknowledged") != std::string::npos;
  EXPECT_EQ(is_said, !all_heard) << outcome.standard_error;
  if (!all_heard) {
    EXPECT_EQ(outcome.exit_code, 3);
  }
  EXPECT_TRUE(json["off_sent"]);
  ASSERT_FALSE(read_timeline(folder_ / "pins.csv").empty());
  EXPECT_THAT(read_timeline(folder_ / "pins.csv").back().level, Each(0));
}

TEST_F(StreamCommand, PressuresArriveAtTheValvesInAllTheirLevels) {
  record("--count 60 --rate 500 --duration 2");
  const test::Outcome outcome = run_with_board(
      "vestige stream trace.mcap --port vest --ttl 2000 --levels pressure --log log.csv --json stream.json",
      "vest-valves");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.standard_error;
  std::vector<Row> sent = read_log(folder_ / "log.csv");
  std::erase_if(sent, [](const Row& row) { return row.state != "sent"; });
  const std::vector<Row> pins = read_timeline(folder_ / "pins.csv");
  std::set<int> levels;
  for (std::size_t valve = 0; valve < 6; ++valve) {
    const Levels commanded = steps_of(valve, sent);
    const Levels measured = steps_of(valve, pins);
    levels.insert(commanded.begin(), commanded.end());
    ASSERT_EQ(measured.size(), commanded.size()) << "valve " << valve + 1;
    for (std::size_t i = 0; i < measured.size(); ++i) EXPECT_NEAR(measured[i], commanded[i], 1) << valve << " " << i;
  }
  EXPECT_GT(levels.size(), 10U);
}

TEST_F(StreamCommand, AVestThatIsUnpluggedWhileItIsDrivenIsFoundAgain) {
  record("--colliders hug --rate 100 --duration 1");
  const std::string board = "simulated_board '" VESTIGE_FIRMWARE_DIR "/vest-atmega1280.elf' --link vest --duties ";
  const test::Outcome outcome =
      run(board +
          "before.csv >/dev/null 2>&1 & first=$!\nfor i in $(seq 200); do [ -e vest ] && break; sleep 0.05; done\n"
          "vestige stream trace.mcap --port vest --loop --hold 1e6 --json stream.json & stream=$!\n"
          "sleep 3; kill -INT $first; wait $first; sleep 0.5\n" +
          board +
          "after.csv >/dev/null 2>&1 & second=$!\n"
          "sleep 3; kill -INT $stream; wait $stream; code=$?; kill -INT $second; wait $second; exit $code");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.standard_error, HasSubstr("the link is back"));
  EXPECT_EQ(json_in("stream.json")["links_lost"], 1);
  const std::vector<Row> after = read_timeline(folder_ / "after.csv");
  ASSERT_FALSE(after.empty());
  EXPECT_TRUE(std::ranges::any_of(after, [](const Row& row) { return row.level != Levels(6); }));
  EXPECT_THAT(after.back().level, Each(0));
}

TEST_F(StreamCommand, AnInterruptedStreamSwitchesTheVestOff) {
  record("--colliders hug --rate 100 --duration 1");
  for (const std::string signal : {"INT", "TERM"}) {
    const test::Outcome outcome =
        run_with_board("vestige stream trace.mcap --port vest --ttl 2000 --loop --hold 1e6 --json " + signal +
                       ".json & stream=$!\nsleep 3; kill -" + signal + " $stream; wait $stream");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.standard_error;
    EXPECT_TRUE(json_in(signal + ".json")["off_acknowledged"]);
    const std::vector<Row> pins = read_timeline(folder_ / "pins.csv");
    ASSERT_FALSE(pins.empty());
    EXPECT_THAT(pins.back().level, Each(0));
    EXPECT_TRUE(std::ranges::any_of(pins, [](const Row& row) { return row.level != Levels(6); }));
    ASSERT_EQ(run("rm -f pins.csv vest").exit_code, 0);
  }
}

TEST_F(StreamCommand, AStreamThatIsInterruptedBeforeItsEndSaysSo) {
  record("--colliders hug --rate 100 --duration 5");
  const test::Outcome outcome = run_with_board(
      "vestige stream trace.mcap --port vest --json stream.json & stream=$!\nsleep 3; kill -INT $stream; wait "
      "$stream");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.standard_error, HasSubstr("stopped"));
  const nlohmann::json json = json_in("stream.json");
  EXPECT_LT(json["frames"], 500);
  EXPECT_TRUE(json["off_acknowledged"]);
  EXPECT_THAT(read_timeline(folder_ / "pins.csv").back().level, Each(0));
}

TEST_F(StreamCommand, AKilledStreamLeavesNoMotorRunning) {
  record("--colliders hug --rate 100 --duration 1");
  run_with_board(
      "vestige stream -q trace.mcap --port vest --loop --hold 1e6 & stream=$!\nsleep 3; kill -KILL $stream\n"
      "wait $stream; sleep 0.5");
  const std::vector<Row> pins = read_timeline(folder_ / "pins.csv");
  ASSERT_FALSE(pins.empty());
  EXPECT_THAT(pins.back().level, Each(0));
  EXPECT_TRUE(std::ranges::any_of(pins, [](const Row& row) { return row.level != Levels(6); }));
}

/// It hardly ever has the processor, as on a busy machine, and must leave out no motor for that.
TEST_F(StreamCommand, VestCheckRunsEachMotorInTurn) {
  const test::Outcome outcome = run_with_board(
      "vestige vest check --port vest --seconds 0.1 --level 100 --ttl 2000 --json check.json & check=$!\n"
      "sleep 0.5; for i in $(seq 20); do kill -STOP $check; sleep 0.2; kill -CONT $check; sleep 0.003; "
      "done; wait $check");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.standard_error;
  EXPECT_THAT(outcome.standard_output, HasSubstr("actuator 6 of 6"));
  EXPECT_THAT(outcome.standard_output, HasSubstr("the vest hears everything"));
  EXPECT_TRUE(json_in("check.json")["good"]);
  EXPECT_TRUE(json_in("check.json")["off_sent"]);
  EXPECT_TRUE(json_in("check.json")["off_acknowledged"]);
  const std::vector<Row> pins = read_timeline(folder_ / "pins.csv");
  for (std::size_t motor = 0; motor < 6; ++motor) {
    const Levels steps = steps_of(motor, pins);
    ASSERT_EQ(steps.size(), 3U) << "motor " << motor + 1;
    EXPECT_NEAR(steps[1], 100, 1);
  }
  for (const Row& row : pins) EXPECT_LE(6 - std::ranges::count(row.level, 0), 1) << row.time_s;
}

TEST_F(StreamCommand, VestCheckSaysThatItWasStoppedAndWhatTheBoardDoesNotDrive) {
  const test::Outcome outcome =
      run_with_board("timeout --preserve-status -s INT 3 vestige vest check --port vest --seconds 0.5 --actuators 12");
  EXPECT_EQ(outcome.exit_code, 3) << outcome.standard_error;
  EXPECT_THAT(outcome.standard_output, HasSubstr("; stopped at actuator "));
  EXPECT_THAT(outcome.standard_output, ::testing::Not(HasSubstr("hears everything")));
  EXPECT_THAT(outcome.standard_error, HasSubstr("the first 6 of 12 actuators"));
  EXPECT_THAT(outcome.standard_error, HasSubstr("Use a map of at most 6 actuators"));
}

TEST_F(StreamCommand, VestCheckOfAVestThatIsUnpluggedFails) {
  const test::Outcome outcome = run_with_board(
      "vestige vest check --port vest --seconds 1 --json check.json & check=$!\n"
      "sleep 3; kill -INT $board; wait $board; wait $check");
  EXPECT_EQ(outcome.exit_code, 4);
  EXPECT_THAT(outcome.standard_output, HasSubstr("the link was lost"));
  EXPECT_THAT(outcome.standard_output, HasSubstr("DOES NOT HEAR"));
  const nlohmann::json json = json_in("check.json");
  EXPECT_FALSE(json["good"]);
  EXPECT_GE(json["links_lost"], 1);
  EXPECT_FALSE(json["off_sent"]);
  EXPECT_FALSE(json["off_acknowledged"]);
}

}  // namespace
}  // namespace vestige
