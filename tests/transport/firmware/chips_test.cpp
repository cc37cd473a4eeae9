#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <tuple>

#include "tests/support/wire_frames.hpp"
#include "tests/transport/firmware/simulated_board.hpp"

// The firmware that drives PCA9685 chips, run in virtual time: times here are the microcontroller's.
namespace vestige::test {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

std::filesystem::path firmware(const std::string& name) {
  return std::filesystem::path(VESTIGE_FIRMWARE_DIR) / (name + ".elf");
}

constexpr double kStart_s = 0.05;  // frees the bus, sets the chips up

class ChipsBench {
 public:
  ChipsBench(const std::string& name, const std::size_t chips) : board(firmware(name), "", 57600, chips) {}

  std::size_t outputs() { return board.motors(); }
  Bytes all(const std::uint8_t level) { return Bytes(outputs(), level); }
  void send(const Bytes& bytes) {
    board.send(bytes);
    board.run_until_sent();
  }
  std::vector<Bytes> answers(const Bytes& bytes) {
    send(bytes);
    board.run_for(0.01);
    return wire_payloads(board.take_received());
  }
  /// Counts of 4096 that each output is high now.
  std::vector<unsigned> high() {
    std::vector<unsigned> counts(outputs());
    for (std::size_t i = 0; i < counts.size(); ++i) counts[i] = board.chips().high_counts(i);
    return counts;
  }
  /// The same, if OE were low.
  std::vector<unsigned> held() {
    std::vector<unsigned> counts(outputs());
    for (std::size_t i = 0; i < counts.size(); ++i)
      counts[i] = board.chips().chip(i / 16).high_counts(i % 16, OutputEnable::kLow);
    return counts;
  }
  static std::vector<unsigned> counts_of(const Bytes& levels) {
    std::vector<unsigned> counts;
    for (const std::uint8_t level : levels) counts.push_back(level == 255 ? 4096 : 16U * level);
    return counts;
  }
  /// Whether all motors have been off since that time.
  bool off_since(const double time_s) {
    const auto rows = board.duties();
    for (auto row = rows.rbegin(); row != rows.rend(); ++row) {
      if (std::ranges::any_of(row->duty, [](const std::uint8_t duty) { return duty != 0; })) return false;
      if (row->time_s <= time_s) return true;
    }
    return true;
  }
  bool no_motor_ever_moved() { return off_since(0); }
  std::vector<std::string> misuses() {
    std::vector<std::string> all;
    for (std::size_t i = 0; i < outputs() / 16; ++i) {
      const auto& of_chip = board.chips().chip(i).misuses();
      all.insert(all.end(), of_chip.begin(), of_chip.end());
    }
    return all;
  }
  /// Runs until OE falls; returns false if it does not within a second.
  bool run_until_enabled() {
    const double until_s = board.time_s() + 1;
    while (board.chips().enable() == OutputEnable::kHigh && board.time_s() < until_s) board.run_for(20e-6);
    return board.chips().enable() == OutputEnable::kLow;
  }

  SimulatedBoard board;
};

class ChipsTest : public ::testing::TestWithParam<std::tuple<const char*, std::size_t>>, public ChipsBench {
 protected:
  ChipsTest()
      : ChipsBench(std::string("vest-") + std::get<0>(GetParam()) + "-" + std::to_string(16 * std::get<1>(GetParam())),
                   std::get<1>(GetParam())) {}
  void SetUp() override { board.run_for(kStart_s); }
  void TearDown() override { EXPECT_THAT(misuses(), IsEmpty()); }
};

INSTANTIATE_TEST_SUITE_P(, ChipsTest,
                         ::testing::Values(std::tuple("atmega1280", 1), std::tuple("atmega1280", 4),
                                           std::tuple("atmega2560", 4)),
                         [](const auto& test) {
                           return std::string(std::get<0>(test.param)) + "_" +
                                  std::to_string(16 * std::get<1>(test.param));
                         });

TEST_P(ChipsTest, SaysHowManyChannelsItHas) {
  const auto channels = static_cast<std::uint8_t>(outputs());
  EXPECT_THAT(answers(hello_frame(5)), ElementsAre(Bytes{'H', 5, 1, channels, 1}));
  EXPECT_THAT(answers(hello_frame(6)), ElementsAre(Bytes{'H', 6, 1, channels, 0}));
  EXPECT_TRUE(no_motor_ever_moved());
}

TEST_P(ChipsTest, StartsItsChipsWithAllMotorsOff) {
  board.run_for(1);
  EXPECT_TRUE(no_motor_ever_moved());
  EXPECT_EQ(board.chips().enable(), OutputEnable::kLow);
  EXPECT_EQ(board.starts(), 1U);
  for (std::size_t i = 0; i < outputs() / 16; ++i) EXPECT_NEAR(board.chips().chip(i).frequency_hz(), 1017.3, 0.1);
}

TEST_P(ChipsTest, GivesEachMotorExactlyTheShareOfTimeThatItIsTold) {
  for (unsigned level = 0; level < 256; ++level) {
    Bytes levels = all(0);
    for (std::size_t i = 0; i < levels.size(); ++i) levels[i] = static_cast<std::uint8_t>(level + 37 * i);
    send(levels_frame('S', 1, 20, levels));
    board.run_for(0.01);
    ASSERT_EQ(high(), counts_of(levels)) << level;
  }
}

TEST_P(ChipsTest, TakesItsLevelsWithinTwoMillisecondsPerChip) {
  answers(levels_frame('S', 1, 20, all(10)));
  send(levels_frame('S', 2, 20, all(20)));
  const double told_s = board.time_s();
  while (high() != counts_of(all(20)) && board.time_s() < told_s + 0.1) board.run_for(10e-6);
  const double taken_s = board.time_s() - told_s;
  const std::size_t chips = outputs() / 16;
  RecordProperty("taken_us", std::to_string(taken_s * 1e6));
  // That the host may leave so little time between frames: board_time() in transport/wire/vest_frame.hpp.
  EXPECT_LT(taken_s, 2e-3 * static_cast<double>(chips));
  EXPECT_GT(taken_s, 1.4e-3 * static_cast<double>(chips)) << "faster than 400 kHz";
}

TEST_P(ChipsTest, SwitchesOffAtOnceWhenToldSo) {
  answers(levels_frame('S', 1, 100, all(200)));
  send(off_frame(2));
  board.run_for(200e-6);
  EXPECT_THAT(high(), Each(0U)) << "all of them, before the chips have been written";
  ASSERT_TRUE(run_until_enabled());
  EXPECT_THAT(high(), Each(0U));
  board.take_received();
  EXPECT_THAT(answers(levels_frame('S', 3, 100, all(3))), ElementsAre(Bytes{'A', 3, 0, 0}));
  EXPECT_EQ(high(), counts_of(all(3)));
}

TEST_P(ChipsTest, SwitchesOffByItselfWhenTheTimeToLiveRunsOut) {
  for (const std::uint8_t ttl_10ms : Bytes{2, 50}) {
    send(levels_frame('S', 1, ttl_10ms, all(255)));
    const double told_s = board.time_s();
    board.run_for(ttl_10ms * 0.01 - 1e-4);
    EXPECT_EQ(high(), counts_of(all(255)));
    board.run_for(2e-3);
    EXPECT_TRUE(off_since(told_s + ttl_10ms * 0.01 + 0.0015));
    ASSERT_TRUE(run_until_enabled());
    EXPECT_THAT(held(), Each(0U));
    board.take_received();
    EXPECT_THAT(answers(off_frame(2)), ElementsAre(Bytes{'A', 2, 1, 0}));
  }
}

TEST_P(ChipsTest, NeverShowsOldLevelsWhenItIsSwitchedOffInTheMiddleOfWritingThem) {
  for (int delay_us = 0; delay_us < 8000; delay_us += 130) {
    answers(off_frame(1));
    ASSERT_TRUE(run_until_enabled());
    send(levels_frame('S', 2, 100, all(255)));
    board.run_for(delay_us * 1e-6);
    send(off_frame(3));
    board.run_for(200e-6);
    const double off_s = board.time_s();
    ASSERT_TRUE(run_until_enabled());
    board.run_for(0.02);
    EXPECT_TRUE(off_since(off_s)) << delay_us;
  }
}

TEST_P(ChipsTest, IsOffWhileItIsInResetAndZeroesItsChipsBeforeItEnablesThem) {
  send(levels_frame('S', 1, 255, all(255)));
  board.run_for(0.02);
  EXPECT_EQ(high(), counts_of(all(255)));
  const double reset_s = board.time_s();
  board.hold_reset(0.5);
  EXPECT_THAT(high(), Each(0U));
  EXPECT_EQ(held(), counts_of(all(255))) << "the chips know nothing of a reset";
  ASSERT_TRUE(run_until_enabled());
  EXPECT_EQ(board.starts(), 2U);
  EXPECT_THAT(held(), Each(0U));
  board.run_for(0.5);
  EXPECT_TRUE(off_since(reset_s + 1e-5));
  board.take_received();
  EXPECT_THAT(answers(levels_frame('S', 2, 20, all(9))), ElementsAre(Bytes{'A', 2, 1, 0}));
  EXPECT_EQ(high(), counts_of(all(9)));
}

TEST_P(ChipsTest, StartsAgainWhereverTheResetCutsAMessageShort) {
  for (int delay_us = 0; delay_us < 2000; delay_us += 47) {
    send(levels_frame('S', 1, 255, all(255)));
    board.run_for(delay_us * 1e-6);
    board.hold_reset(0.001);
    board.chips().set_fault(BusFault::kSdaLowUntilClocks);
    ASSERT_TRUE(run_until_enabled()) << delay_us;
    EXPECT_THAT(held(), Each(0U)) << delay_us;
  }
}

TEST_P(ChipsTest, IsRestartedOffByItsWatchdogWhenTheProgramGoesAstray) {
  send(levels_frame('S', 1, 255, all(255)));
  board.run_for(0.02);
  const double astray_s = board.time_s();
  board.derail();
  board.run_for(0.5);
  EXPECT_EQ(board.starts(), 2U);
  EXPECT_TRUE(off_since(astray_s + 0.26));
  EXPECT_THAT(held(), Each(0U));
}

TEST_P(ChipsTest, IsOffAfterThePowerHasFailed) {
  send(levels_frame('S', 1, 255, all(255)));
  board.run_for(0.02);
  const double failed_s = board.time_s();
  board.power_cycle();
  board.run_for(0.5);
  EXPECT_TRUE(off_since(failed_s));
  board.take_received();
  answers(levels_frame('S', 2, 20, all(7)));
  EXPECT_EQ(high(), counts_of(all(7)));
}

TEST_P(ChipsTest, IsOffWhileTheBusHangsSaysSoAndGoesOn) {
  for (const BusFault fault : {BusFault::kSclLow, BusFault::kSdaLow}) {
    answers(levels_frame('S', 1, 255, all(100)));
    EXPECT_EQ(high(), counts_of(all(100)));
    answers(off_frame(0));  // takes the flags
    answers(levels_frame('S', 1, 255, all(100)));
    board.chips().set_fault(fault);
    send(levels_frame('S', 2, 255, all(101)));  // which nobody could tell the chips
    const double hung_s = board.time_s();
    board.run_for(0.01);
    for (int i = 0; i < 40; ++i) {
      board.take_received();
      const auto heard = answers(levels_frame('S', 3, 255, all(102)));
      ASSERT_EQ(heard.size(), 1U) << "it goes on answering";
      EXPECT_EQ(heard[0], (Bytes{'A', 3, 5, 0})) << i;
    }
    EXPECT_TRUE(off_since(hung_s + 0.005));
    board.chips().set_fault(BusFault::kNone);
    board.run_for(0.1);
    EXPECT_EQ(high(), counts_of(all(102))) << "what was asked for last";
    board.take_received();
    EXPECT_THAT(answers(levels_frame('S', 4, 255, all(103))), ElementsAre(Bytes{'A', 4, 5, 0})) << "it says so";
    EXPECT_THAT(answers(levels_frame('S', 5, 255, all(104))), ElementsAre(Bytes{'A', 5, 0, 0})) << "once";
    EXPECT_EQ(high(), counts_of(all(104)));
    EXPECT_EQ(board.starts(), 1U) << "no watchdog was needed";
  }
}

TEST_P(ChipsTest, SwitchesOffAtTheEndOfTheTimeToLiveThoughTheBusHangs) {
  answers(levels_frame('S', 1, 10, all(100)));
  board.chips().set_fault(BusFault::kSdaLow);
  const double hung_s = board.time_s();
  board.run_for(0.3);
  EXPECT_TRUE(off_since(hung_s + 0.1));
  board.chips().set_fault(BusFault::kNone);
  ASSERT_TRUE(run_until_enabled());
  board.run_for(0.1);
  EXPECT_TRUE(off_since(hung_s + 0.1));
  EXPECT_THAT(held(), Each(0U));
}

TEST_P(ChipsTest, FreesABusThatAChipHolds) {
  for (int delay_us = 0; delay_us < 1500; delay_us += 211) {
    answers(levels_frame('S', 1, 255, all(100)));
    send(levels_frame('S', 2, 255, all(50)));
    board.run_for(delay_us * 1e-6);
    board.chips().set_fault(BusFault::kSdaLowUntilClocks);
    board.run_for(0.1);
    EXPECT_EQ(high(), counts_of(all(50))) << delay_us;
    board.take_received();
    EXPECT_EQ(answers(off_frame(3)).at(0)[2] & 4, 4) << delay_us;
  }
}

TEST_P(ChipsTest, IsOffWhileOneChipDoesNotAnswer) {
  for (std::size_t chip = 0; chip < outputs() / 16; ++chip) {
    answers(levels_frame('S', 1, 255, all(100)));
    answers(off_frame(0));
    answers(levels_frame('S', 1, 255, all(100)));
    board.chips().set_deaf(chip, true);
    send(levels_frame('S', 2, 255, all(101)));
    const double deaf_s = board.time_s();
    board.run_for(0.5);
    EXPECT_TRUE(off_since(deaf_s + 2e-3 * static_cast<double>(chip + 1)));
    board.take_received();
    EXPECT_THAT(answers(levels_frame('S', 3, 255, all(102))), ElementsAre(Bytes{'A', 3, 5, 0}));
    board.chips().set_deaf(chip, false);
    board.run_for(0.1);
    EXPECT_EQ(high(), counts_of(all(102)));
  }
}

TEST_P(ChipsTest, MovesNoMotorForRandomBytesAndAnswersTheNextFrame) {
  std::mt19937 random(9685);
  Bytes noise(20'000);
  for (std::uint8_t& byte : noise) byte = static_cast<std::uint8_t>(random());
  noise.push_back(0);
  send(noise);
  board.run_for(0.1);
  EXPECT_TRUE(no_motor_ever_moved());
  EXPECT_THAT(board.take_received(), IsEmpty());
  EXPECT_EQ(answers(levels_frame('S', 1, 20, all(9))).size(), 1U);
  EXPECT_EQ(high(), counts_of(all(9)));
}

TEST_P(ChipsTest, ObeysAndAnswersFramesThatComeWithoutAPause) {
  answers(hello_frame(0));
  Bytes line;
  std::vector<Bytes> expected;
  for (unsigned i = 0; i < 100; ++i) {
    const auto sequence = static_cast<std::uint8_t>(i);
    Bytes levels = all(sequence);
    levels[0] = 7;
    const Bytes frame = levels_frame('S', sequence, 20, levels);
    line.insert(line.end(), frame.begin(), frame.end());
    expected.push_back({'A', sequence, 0, 0});
  }
  EXPECT_EQ(answers(line), expected);
  Bytes last = all(99);
  last[0] = 7;
  EXPECT_EQ(high(), counts_of(last));
}

TEST(ChipsOptions, OfTwoOrThreeChipsGiveSoManyMotorsTheirLevels) {
  for (const std::size_t chips : {2U, 3U}) {
    ChipsBench bench("vest-atmega2560-" + std::to_string(16 * chips), chips);
    bench.board.run_for(kStart_s);
    const auto motors = static_cast<std::uint8_t>(16 * chips);
    EXPECT_THAT(bench.answers(hello_frame(5)), ElementsAre(Bytes{'H', 5, 1, motors, 1}));
    Bytes levels = bench.all(0);
    for (std::size_t i = 0; i < levels.size(); ++i) levels[i] = static_cast<std::uint8_t>(5 * i);
    bench.answers(levels_frame('S', 1, 20, levels));
    EXPECT_EQ(bench.high(), ChipsBench::counts_of(levels));
  }
}

TEST(ChipsThatAreMissing, KeepAllMotorsOffAndTheHelloSaysSo) {
  ChipsBench bench("vest-atmega1280-64", 3);
  bench.board.run_for(0.5);
  EXPECT_EQ(bench.board.chips().enable(), OutputEnable::kHigh);
  EXPECT_THAT(bench.answers(hello_frame(1)), ElementsAre(Bytes{'H', 1, 1, 64, 5}));
  bench.send(levels_frame('S', 1, 20, Bytes(64, 200)));
  bench.board.run_for(0.5);
  EXPECT_TRUE(bench.no_motor_ever_moved());
}

TEST(ChipsOptions, AKickStartDrivesAMotorFullyWhileItStartsFromRest) {
  ChipsBench bench("vest-kick-start-16", 1);  // of 50 ms
  bench.board.run_for(kStart_s);
  Bytes levels = bench.all(0);
  levels[0] = 64;
  levels[15] = 255;
  bench.send(levels_frame('S', 1, 100, levels));
  bench.board.run_for(0.005);
  EXPECT_EQ(bench.high()[0], 4096U);
  EXPECT_EQ(bench.high()[1], 0U);
  bench.board.run_for(0.043);
  EXPECT_EQ(bench.high()[0], 4096U);
  bench.board.run_for(0.006);
  EXPECT_EQ(bench.high(), ChipsBench::counts_of(levels));
}

}  // namespace
}  // namespace vestige::test
