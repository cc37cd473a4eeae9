// Streams traces as a user does, to what stands in for bHaptics' Player.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/background_process.hpp"
#include "tests/support/bhaptics/player.hpp"
#include "tests/support/command_line.hpp"

namespace vestige {
namespace {

using test::BhapticsPlayer;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class StreamToBhaptics : public test::CommandLineTest {
 protected:
  /// A hug that is felt by a bHaptics vest.
  void record(const std::string& flags = "--map torso40") const {
    ASSERT_EQ(run("vestige record --colliders hug --rate 100 --duration 1 -q -o trace.mcap " + flags).exit_code, 0);
  }

  static std::string stream(std::uint16_t port, const std::string& flags = "") {
    return fmt::format("vestige stream trace.mcap --port bhaptics://127.0.0.1:{} --json stream.json {}", port, flags);
  }
};

TEST_F(StreamToBhaptics, TheLayoutTorso40IsFeltOnBothSides) {
  record();
  BhapticsPlayer player(folder_.path());
  const test::Outcome outcome = run(stream(player.port()));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.standard_error;
  EXPECT_EQ(outcome.standard_error, "");
  EXPECT_THAT(outcome.standard_output, HasSubstr("all actuators off at the end: sent"));
  const nlohmann::json report = player.report();
  EXPECT_THAT(report["faults"], IsEmpty());
  EXPECT_THAT(report["left_on"], IsEmpty());
  EXPECT_EQ(report["most"].size(), 40U);
  EXPECT_EQ(report["most"]["VestFront 8"], 100);
  EXPECT_EQ(report["most"]["VestBack 8"], 100);
  const nlohmann::json json = json_in("stream.json");
  EXPECT_EQ(json["sent"], report["texts"]);
  EXPECT_EQ(json["link"]["texts"], report["texts"]);
  EXPECT_EQ(json["link"]["duration_ms"], 60);
  EXPECT_EQ(json["links_lost"], 0);
  EXPECT_EQ(json["off_sent"], true);
}

TEST_F(StreamToBhaptics, FramesNeverOutliveTheTimeToLive) {
  record();
  BhapticsPlayer player(folder_.path(), {"--most-ms", "50"});
  ASSERT_EQ(run(stream(player.port(), "--ttl 50")).exit_code, 0);
  EXPECT_THAT(player.report()["faults"], IsEmpty());
  EXPECT_EQ(json_in("stream.json")["link"]["duration_ms"], 50);
}

TEST_F(StreamToBhaptics, CtrlCLeavesNothingOn) {
  record();
  BhapticsPlayer player(folder_.path());
  test::BackgroundProcess process({"vestige", "stream", (folder_ / "trace.mcap").string(), "--loop", "--port",
                                   fmt::format("BHAPTICS://127.0.0.1:{}", player.port())},
                                  folder_ / "error");
  ASSERT_TRUE(player.wait_for("on"));
  process.signal(SIGINT);
  EXPECT_EQ(process.wait(), 0);
  const nlohmann::json report = player.report();
  EXPECT_THAT(report["left_on"], IsEmpty()) << report;
  EXPECT_THAT(report["faults"], IsEmpty()) << report;
}

TEST_F(StreamToBhaptics, APlayerThatGoesIsLookedForAgain) {
  record();
  BhapticsPlayer player(folder_.path(), {"--texts", "10", "--connections", "2"});
  const test::Outcome outcome = run(stream(player.port(), "--rate 0.5"));
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.standard_error, AllOf(HasSubstr("the connection was closed"), HasSubstr("the link is back"),
                                            HasSubstr("could not be sent")));
  const nlohmann::json json = json_in("stream.json");
  EXPECT_EQ(json["links_lost"], 2);
  EXPECT_GE(json["link"]["texts"], 20);
  EXPECT_EQ(json["off_sent"], false);
}

TEST_F(StreamToBhaptics, APlayerThatIsNotThereIsSaidOnce) {
  record();
  const std::uint16_t port = BhapticsPlayer(folder_.path()).port();  // which is free again
  const test::Outcome outcome = run(stream(port));
  EXPECT_EQ(outcome.exit_code, 3);
  const std::string missed = "there is no connection to bHaptics' Player";
  const std::size_t first = outcome.standard_error.find(missed);
  ASSERT_NE(first, std::string::npos) << outcome.standard_error;
  EXPECT_EQ(outcome.standard_error.find(missed, first + 1), std::string::npos) << outcome.standard_error;
  EXPECT_EQ(json_in("stream.json")["links_lost"], 1);
  EXPECT_EQ(json_in("stream.json")["sent"], 0);
}

TEST_F(StreamToBhaptics, WhatCannotBeFeltIsRefused) {
  record("");
  const std::string port = "--port bhaptics://127.0.0.1";
  expect_failure("vestige stream trace.mcap " + port, 1, {"no vibrator for the actuator", "--map torso40"});
  expect_failure("vestige stream trace.mcap --map torso40 --baud 9600 " + port, 2, {"--baud", "not a serial port"});
  expect_failure("vestige stream trace.mcap --map torso40 --osc-address /a/{n} " + port, 2, {"--osc-address"});
  expect_failure("vestige stream trace.mcap --map torso40 " + port + ":0", 2, {"--port", "bhaptics://127.0.0.1:15881"});
  expect_failure("vestige vest check --actuators 41 " + port, 1, {"'41'"});
}

TEST_F(StreamToBhaptics, VestCheckRunsAllFortyInTurn) {
  BhapticsPlayer player(folder_.path());
  const test::Outcome outcome =
      run(fmt::format("vestige vest check --port bhaptics://127.0.0.1:{} --seconds 0.05 --level 128", player.port()));
  EXPECT_EQ(outcome.exit_code, 0) << outcome.standard_error;
  EXPECT_THAT(outcome.standard_output, HasSubstr("actuator 40 of 40"));
  const nlohmann::json report = player.report();
  EXPECT_THAT(report["faults"], IsEmpty());
  EXPECT_THAT(report["left_on"], IsEmpty());
  EXPECT_EQ(report["most"].size(), 40U);
  for (const auto& [name, most] : report["most"].items()) EXPECT_EQ(most, 50) << name;
}

}  // namespace
}  // namespace vestige
