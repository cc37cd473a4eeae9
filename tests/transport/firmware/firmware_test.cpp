#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <sstream>
#include <string>

#include "tests/support/process.hpp"
#include "tests/support/wire_frames.hpp"
#include "tests/transport/firmware/simulated_board.hpp"

// The firmware's own ELF, run in virtual time: times here are the microcontroller's, the same on every machine.
namespace vestige::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

using Duties = std::array<std::uint8_t, SimulatedBoard::kPins>;

std::filesystem::path firmware(const std::string& name) {
  return std::filesystem::path(VESTIGE_FIRMWARE_DIR) / (name + ".elf");
}

/// A board that has started, and what one says to it.
class Bench {
 public:
  explicit Bench(const std::string& name) : board(firmware(name)) { board.run_for(0.01); }

  void send(const Bytes& bytes) {
    board.send(bytes);
    board.run_until_sent();
  }
  /// What the board answers, all of it: ten milliseconds are more than an answer needs.
  std::vector<Bytes> answers(const Bytes& bytes) {
    send(bytes);
    board.run_for(0.01);
    return wire_payloads(board.take_received());
  }
  /// The last answer's count of damaged frames.
  int receive_errors() {
    const auto answer = answers(off_frame(99));
    return answer.size() == 1 && answer[0].size() == 4 ? answer[0][3] : -1;
  }

  /// Clock cycles that each pin was high in the following whole periods.
  std::array<std::uint64_t, SimulatedBoard::kPins> high_cycles(const std::uint64_t periods) {
    std::array<std::uint64_t, SimulatedBoard::kPins> high{};
    for (std::size_t i = 0; i < high.size(); ++i) high[i] = board.pin(i).high_cycles(board.cycle());
    board.run_until_cycle(board.cycle() + periods * PinDuty::kPeriod_cycles);
    for (std::size_t i = 0; i < high.size(); ++i) high[i] = board.pin(i).high_cycles(board.cycle()) - high[i];
    return high;
  }
  /// Duties now, measured over two whole periods after two in which changes settle.
  Duties duties() {
    high_cycles(2);
    const auto high = high_cycles(2);
    Duties duties{};
    for (std::size_t i = 0; i < high.size(); ++i) {
      duties[i] = static_cast<std::uint8_t>(std::min<std::uint64_t>((high[i] + 64) / 128, 255));
    }
    return duties;
  }
  /// When the last motor went low for good, as far as one knows by now.
  double last_high_s() {
    double last_s = 0;
    for (const DutyRow& row : board.duties()) last_s = std::max(last_s, row.time_s);
    return last_s;
  }
  bool no_motor_ever_moved() {
    for (std::size_t i = 0; i < SimulatedBoard::kPins; ++i) {
      if (board.pin(i).high_cycles(board.cycle()) != 0) return false;
    }
    return true;
  }

  SimulatedBoard board;
};

const Bytes kLevels = {10, 20, 30, 40, 50, 60};
constexpr Duties kMeasured = {10, 20, 30, 40, 50, 60};
constexpr Duties kOff = {};

class FirmwareTest : public ::testing::TestWithParam<const char*>, public Bench {
 protected:
  FirmwareTest() : Bench(std::string("vest-") + GetParam()) {}
};

INSTANTIATE_TEST_SUITE_P(, FirmwareTest, ::testing::Values("atmega1280", "atmega2560"),
                         [](const auto& test) { return std::string(test.param); });

TEST_P(FirmwareTest, FitsIntoFourKibibytesOfFlash) {
  const Outcome outcome = run("avr-size -B '" + firmware(std::string("vest-") + GetParam()).string() + "'", "/");
  std::istringstream lines(outcome.standard_output);
  std::string header;
  std::getline(lines, header);
  std::uint64_t text = 0;
  std::uint64_t data = 0;
  std::uint64_t bss = 0;
  ASSERT_TRUE(lines >> text >> data >> bss) << outcome.standard_output << outcome.standard_error;
  RecordProperty("flash_bytes", std::to_string(text + data));
  RecordProperty("ram_bytes", std::to_string(data + bss));
  EXPECT_GT(text, 500U);
  EXPECT_LT(text + data, 4096U);
  EXPECT_LT(data + bss, 8192U - 1024U) << "the stack needs room, too";
}

TEST_P(FirmwareTest, StartsWithAllMotorsOffAndSaysNothingUnasked) {
  board.run_for(1);
  EXPECT_TRUE(no_motor_ever_moved());
  EXPECT_THAT(board.take_received(), IsEmpty());
  EXPECT_EQ(board.starts(), 1U);
}

TEST_P(FirmwareTest, AnswersHelloWithItsVersionAndActuatorCountAndSaysOnceThatItHasJustStarted) {
  EXPECT_THAT(answers(hello_frame(5)), ElementsAre(Bytes{'H', 5, 1, 6, 1}));
  EXPECT_THAT(answers(hello_frame(6)), ElementsAre(Bytes{'H', 6, 1, 6, 0}));
  EXPECT_TRUE(no_motor_ever_moved());
}

TEST_P(FirmwareTest, SpeaksTheWireByteForByte) {
  // Made by another program: Python's binascii.crc_hqx, and COBS by hand.
  const Bytes hello = {0x05, 0x48, 0x05, 0xCF, 0xC9, 0x00};
  const Bytes hello_answer = {0x08, 0x48, 0x05, 0x01, 0x06, 0x01, 0xBB, 0x33, 0x00};
  const Bytes levels = {0x05, 0x53, 0x07, 0x14, 0x06, 0x05, 0x01, 0x80, 0xFE, 0xFF, 0x03, 0xE8, 0x18, 0x00};
  const Bytes levels_answer = {0x03, 0x41, 0x07, 0x01, 0x03, 0x78, 0x19, 0x00};
  EXPECT_EQ(hello_frame(5), hello);
  EXPECT_EQ(levels_frame('S', 7, 20, {0, 1, 128, 254, 255, 0}), levels);
  send(hello);
  board.run_for(0.01);
  EXPECT_EQ(board.take_received(), hello_answer);
  send(levels);
  board.run_for(0.01);
  EXPECT_EQ(board.take_received(), levels_answer);
  EXPECT_EQ(duties(), (Duties{0, 1, 128, 254, 255, 0}));
}

TEST_P(FirmwareTest, GivesEachMotorExactlyTheShareOfTimeThatItIsTold) {
  constexpr std::uint64_t kPeriods = 3;
  for (unsigned level = 0; level < 256; ++level) {
    Bytes levels;
    for (unsigned motor = 0; motor < SimulatedBoard::kPins; ++motor) {
      levels.push_back(static_cast<std::uint8_t>(level + 43 * motor));
    }
    send(levels_frame('S', static_cast<std::uint8_t>(level), 20, levels));
    high_cycles(2);
    const auto high = high_cycles(kPeriods);
    for (std::size_t motor = 0; motor < SimulatedBoard::kPins; ++motor) {
      const std::uint64_t share = levels[motor] == 255 ? 256 : levels[motor];
      // 0.01 %: a cycle or two of each period's 16384, for an interrupt that holds the timer up.
      EXPECT_NEAR(static_cast<double>(high[motor]), static_cast<double>(kPeriods * 64 * share), 1.6 * kPeriods)
          << "motor " << motor + 1 << " at " << int{levels[motor]};
    }
  }
}

TEST_P(FirmwareTest, SetsAbsoluteStateWhateverTheNumberOfLevels) {
  Bytes many = kLevels;
  many.resize(255, 200);
  EXPECT_THAT(answers(levels_frame('S', 1, 20, many)), ElementsAre(Bytes{'A', 1, 1, 0}));
  EXPECT_EQ(duties(), kMeasured) << "levels for motors that the board does not have are ignored";
  EXPECT_THAT(answers(levels_frame('S', 2, 20, {70, 80})), ElementsAre(Bytes{'A', 2, 0, 0}));
  EXPECT_EQ(duties(), (Duties{70, 80, 0, 0, 0, 0})) << "motors that are not named are off";
  EXPECT_THAT(answers(levels_frame('S', 3, 20, {})), ElementsAre(Bytes{'A', 3, 0, 0}));
  EXPECT_EQ(duties(), kOff);
}

TEST_P(FirmwareTest, SwitchesOffWhenToldSoInTheLongFormAndTheShort) {
  for (const Bytes& off : {off_frame(9), wire_frame({'X', 9})}) {
    send(levels_frame('S', 8, 100, kLevels));
    EXPECT_EQ(duties(), kMeasured);
    board.take_received();
    EXPECT_THAT(answers(off), ElementsAre(Bytes{'A', 9, 0, 0}));
    EXPECT_EQ(duties(), kOff);
  }
  board.run_for(2);
  EXPECT_THAT(answers(off_frame(10)), ElementsAre(Bytes{'A', 10, 0, 0})) << "off when told is no fail-safe";
}

TEST_P(FirmwareTest, AnswersTwoHundredFramesThatComeWithoutAPause) {
  answers(hello_frame(0));
  Bytes line;
  std::vector<Bytes> expected;
  for (unsigned i = 0; i < 200; ++i) {
    const auto sequence = static_cast<std::uint8_t>(i);
    const Bytes frame = levels_frame('S', sequence, 20, {sequence, 1, 2, 3, 4, 5});
    line.insert(line.end(), frame.begin(), frame.end());
    expected.push_back({'A', sequence, 0, 0});
  }
  EXPECT_EQ(answers(line), expected);
  EXPECT_EQ(duties(), (Duties{199, 1, 2, 3, 4, 5}));
}

TEST_P(FirmwareTest, ObeysEvenWhereTheLineHasNoRoomForAllAnswers) {
  Bytes line;
  for (unsigned i = 0; i < 400; ++i) {
    const Bytes frame = hello_frame(static_cast<std::uint8_t>(i));
    line.insert(line.end(), frame.begin(), frame.end());
  }
  const Bytes last = levels_frame('S', 77, 100, kLevels);
  line.insert(line.end(), last.begin(), last.end());
  send(line);
  EXPECT_EQ(duties(), kMeasured);
  board.run_for(0.1);
  const auto heard = wire_payloads(board.take_received());
  EXPECT_GT(heard.size(), 250U);
  EXPECT_LT(heard.size(), 400U);
  EXPECT_THAT(heard, ::testing::Each(::testing::Not(IsEmpty()))) << "an answer is left out whole";
  EXPECT_EQ(receive_errors(), 0);
}

TEST_P(FirmwareTest, SwitchesOffByItselfWhenTheTimeToLiveRunsOut) {
  for (const std::uint8_t ttl_10ms : Bytes{1, 10, 20, 255}) {
    send(levels_frame('S', 1, ttl_10ms, {255, 255, 255, 255, 255, 255}));
    const double told_s = board.time_s();
    board.run_for(ttl_10ms * 0.01 + 0.05);
    for (std::size_t motor = 0; motor < SimulatedBoard::kPins; ++motor) {
      const DutyChange last = board.pin(motor).changes().back();
      const double held_s = static_cast<double>(last.cycle) / static_cast<double>(SimulatedBoard::kClock_hz) - told_s;
      EXPECT_EQ(last.duty, 0);
      EXPECT_GE(held_s, ttl_10ms * 0.01);
      EXPECT_LE(held_s, ttl_10ms * 0.01 + 0.002) << "the promise is ttl + 10 ms";
    }
    board.take_received();
    EXPECT_THAT(answers(off_frame(2)), ElementsAre(Bytes{'A', 2, 1, 0})) << "it says so";
    EXPECT_THAT(answers(off_frame(3)), ElementsAre(Bytes{'A', 3, 0, 0})) << "once";
  }
}

TEST_P(FirmwareTest, StaysOnWhileFramesKeepComing) {
  for (int i = 0; i < 40; ++i) {
    send(levels_frame('S', 1, 10, kLevels));
    board.run_for(0.05);
  }
  const auto rows = board.duties();
  EXPECT_EQ(
      std::count_if(rows.begin(), rows.end(), [](const DutyRow& row) { return std::ranges::equal(row.duty, kOff); }), 1)
      << "only before the first frame";
  EXPECT_EQ(duties(), kMeasured);
}

TEST_P(FirmwareTest, SwitchesOffByItselfWhenTheHostDiesInTheMiddleOfAFrame) {
  send(levels_frame('S', 1, 10, {255, 255, 255, 255, 255, 255}));
  const double told_s = board.time_s();
  Bytes half = levels_frame('S', 2, 10, kLevels);
  half.resize(half.size() / 2);
  send(half);
  board.run_for(0.2);
  EXPECT_LE(last_high_s() - told_s, 0.11);
  EXPECT_EQ(duties(), kOff);
}

TEST_P(FirmwareTest, HoldsNothingThatHasNoTimeToLive) {
  send(levels_frame('S', 1, 0, {255, 255, 255, 255, 255, 255}));
  board.run_for(0.002);
  EXPECT_EQ(duties(), kOff);
}

TEST_P(FirmwareTest, IsOffAfterThePowerHasFailed) {
  send(levels_frame('S', 1, 255, kLevels));
  EXPECT_EQ(duties(), kMeasured);
  board.power_cycle();
  const auto high = high_cycles(200);
  EXPECT_THAT(high, ::testing::Each(0U));
  EXPECT_EQ(board.starts(), 2U);
  board.take_received();
  EXPECT_THAT(answers(levels_frame('S', 2, 20, kLevels)), ElementsAre(Bytes{'A', 2, 1, 0}))
      << "and the host learns from the flag that the vest was off";
  EXPECT_EQ(duties(), kMeasured);
}

TEST_P(FirmwareTest, IsRestartedOffByItsWatchdogWhenTheProgramGoesAstray) {
  send(levels_frame('S', 1, 255, {255, 200, 100, 50, 25, 255}));
  EXPECT_EQ(duties(), (Duties{255, 200, 100, 50, 25, 255}));
  const double astray_s = board.time_s();
  board.derail();
  board.run_for(0.3);
  EXPECT_EQ(board.starts(), 2U);
  EXPECT_LE(last_high_s() - astray_s, 0.26);
  EXPECT_EQ(duties(), kOff);
  board.run_for(1);
  EXPECT_EQ(board.starts(), 2U) << "the watchdog must not bite again";
  board.take_received();
  EXPECT_THAT(answers(hello_frame(4)), ElementsAre(Bytes{'H', 4, 1, 6, 1}));
}

TEST_P(FirmwareTest, IsRestartedOffByItsWatchdogWhenTheClockOfTheTimeToLiveStops) {
  send(levels_frame('S', 1, 20, {255, 255, 255, 255, 255, 255}));
  const double stopped_s = board.time_s();
  constexpr std::uint16_t kTimer0Interrupts = 0x6E;
  board.disturb(kTimer0Interrupts, 0);
  for (int i = 0; i < 100; ++i) {
    send(hello_frame(1));  // keeps the program busy
    board.run_for(0.005);
  }
  EXPECT_EQ(board.starts(), 2U);
  EXPECT_LE(last_high_s() - stopped_s, 0.26);
  EXPECT_EQ(duties(), kOff);
}

TEST_P(FirmwareTest, MovesNoMotorForAMillionRandomBytesAndAnswersTheNextFrame) {
  std::mt19937 random(20100417);
  Bytes noise(1'000'000);
  for (std::uint8_t& byte : noise) byte = static_cast<std::uint8_t>(random());
  noise.push_back(0);
  send(noise);
  board.run_for(0.1);
  EXPECT_TRUE(no_motor_ever_moved());
  EXPECT_THAT(board.take_received(), IsEmpty());
  const auto heard = answers(levels_frame('S', 1, 20, kLevels));
  ASSERT_EQ(heard.size(), 1U);
  EXPECT_THAT(Bytes(heard[0].begin(), heard[0].begin() + 2), ElementsAre('A', 1));
  EXPECT_EQ(duties(), kMeasured);
}

TEST_P(FirmwareTest, NeverObeysAFrameWithOneBitFlipped) {
  // Every bit of every byte, the delimiter's too: then the next frame is drowned with this one, and the one after
  // heard.
  const Bytes next = levels_frame('S', 2, 255, {0, 0, 0, 0, 0, 7});
  const std::vector<Bytes> frames = {levels_frame('S', 7, 20, {0, 1, 128, 254, 255, 0}),
                                     levels_frame('S', 0, 20, {51, 102, 153, 204, 255, 1}),
                                     levels_frame('S', 255, 1, {1, 0, 0, 0, 0, 0})};
  for (const Bytes& frame : frames) {
    for (std::size_t bit = 0; bit < 8 * frame.size(); ++bit) {
      Bytes flipped = frame;
      flipped[bit / 8] = static_cast<std::uint8_t>(flipped[bit / 8] ^ (1U << (bit % 8)));
      EXPECT_THAT(answers(flipped), IsEmpty()) << "bit " << bit;
      EXPECT_EQ(duties(), kOff) << "bit " << bit;
      const auto after = answers(next);
      const bool drowned = bit / 8 + 1 == frame.size();
      EXPECT_EQ(after.size(), drowned ? 0U : 1U) << "bit " << bit;
      EXPECT_EQ(duties(), drowned ? kOff : (Duties{0, 0, 0, 0, 0, 7})) << "bit " << bit;
      EXPECT_EQ(answers(off_frame(3)).size(), 1U) << "bit " << bit;
      EXPECT_EQ(duties(), kOff);
    }
  }
}

TEST_P(FirmwareTest, CountsDamagedFramesAndNothingElse) {
  EXPECT_EQ(receive_errors(), 0);
  send(Bytes(100, 0));
  send({1, 0});
  EXPECT_EQ(receive_errors(), 0) << "delimiters alone and empty frames are none";
  Bytes wrong = levels_frame('S', 1, 20, kLevels);
  wrong[5] ^= 0x10;
  send(wrong);
  EXPECT_EQ(receive_errors(), 1);
  send({5, 1, 2, 0});
  EXPECT_EQ(receive_errors(), 2) << "a block that ends too early";
  send({2, 7, 0});
  EXPECT_EQ(receive_errors(), 3) << "too short for a checksum";
  for (int i = 0; i < 253; ++i) send(wrong);
  EXPECT_EQ(receive_errors(), 0) << "the count is modulo 256";
}

TEST_P(FirmwareTest, RefusesWhatIsWholeButMakesNoSense) {
  const std::vector<Bytes> payloads = {
      {'S', 1, 20, 6, 10, 20, 30, 40, 50},          // one level too few
      {'S', 1, 20, 6, 10, 20, 30, 40, 50, 60, 70},  // one too many
      {'S', 1, 20},
      {'S'},
      {'X'},
      {'H', 1, 0},
      {'s', 1, 20, 6, 10, 20, 30, 40, 50, 60},
      {'A', 1, 0, 0},
      {'P', 1, 20, 6, 10, 20, 30, 40, 50, 60},  // pressures are not for vibrators
      {0, 0, 0, 0},
  };
  for (const Bytes& payload : payloads) EXPECT_THAT(answers(wire_frame(payload)), IsEmpty());
  EXPECT_TRUE(no_motor_ever_moved());
  EXPECT_EQ(receive_errors(), static_cast<int>(payloads.size()));
}

TEST_P(FirmwareTest, RefusesFramesThatAreTooLongAndHearsTheNext) {
  for (const std::size_t length : {256U, 300U, 1000U, 70000U}) {
    Bytes payload = {'S', 1, 20, 255};
    payload.resize(4 + length, 255);
    EXPECT_THAT(answers(wire_frame(payload)), IsEmpty()) << length;
  }
  // One that would be right, were it not for what follows.
  Bytes payload = {'S', 1, 20, 255};
  payload.resize(4 + 255, 100);
  const unsigned crc = crc_ccitt_false(payload);
  for (const unsigned byte : {crc & 0xFF, crc >> 8, 1U, 2U}) payload.push_back(static_cast<std::uint8_t>(byte));
  EXPECT_THAT(answers(wire_frame(payload)), IsEmpty());
  EXPECT_TRUE(no_motor_ever_moved());
  EXPECT_EQ(receive_errors(), 5);
}

TEST_P(FirmwareTest, SaysWhenBytesWereLost) {
  answers(hello_frame(0));
  board.overrun(Bytes(100, 1));
  board.run_for(0.1);
  send({0});
  EXPECT_THAT(answers(levels_frame('S', 1, 20, kLevels)), ElementsAre(Bytes{'A', 1, 2, 1}));
  EXPECT_THAT(answers(levels_frame('S', 2, 20, kLevels)), ElementsAre(Bytes{'A', 2, 0, 1}));
}

TEST(FirmwareOptionsTest, AKickStartDrivesAMotorFullyWhileItStartsFromRest) {
  Bench bench("vest-kick-start");  // of 50 ms
  const auto milliseconds_on = [&](const std::size_t motor, const double window_s) {
    const std::uint64_t before = bench.board.pin(motor).high_cycles(bench.board.cycle());
    bench.board.run_for(window_s);
    return static_cast<double>(bench.board.pin(motor).high_cycles(bench.board.cycle()) - before) / 16000;
  };
  bench.send(levels_frame('S', 1, 100, {64, 0, 255}));
  bench.board.run_for(0.002);
  EXPECT_NEAR(milliseconds_on(0, 0.045), 45, 1e-3);
  bench.board.run_for(0.005);
  EXPECT_EQ(bench.duties(), (Duties{64, 0, 255, 0, 0, 0}));
  bench.send(levels_frame('S', 2, 100, {32, 0, 255}));
  EXPECT_EQ(bench.duties(), (Duties{32, 0, 255, 0, 0, 0})) << "a motor that turns needs no kick";
  bench.send(levels_frame('S', 3, 100, {0, 32, 0}));
  bench.board.run_for(0.002);
  EXPECT_EQ(milliseconds_on(0, 0.01), 0) << "off is at once";
  bench.send(levels_frame('S', 4, 100, {0, 0, 0}));
  bench.board.run_for(0.002);
  EXPECT_EQ(milliseconds_on(1, 0.1), 0) << "and ends a kick";
  bench.send(levels_frame('S', 5, 2, {1, 1, 1}));
  bench.board.run_for(0.025);
  EXPECT_EQ(milliseconds_on(0, 0.1), 0) << "the time to live ends it, too";
}

TEST(FirmwareOptionsTest, ABoardOfValvesTakesPressuresAndNoDuties) {
  Bench bench("vest-valves");
  EXPECT_THAT(bench.answers(levels_frame('S', 1, 20, kLevels)), IsEmpty());
  EXPECT_TRUE(bench.no_motor_ever_moved());
  EXPECT_THAT(bench.answers(levels_frame('P', 2, 20, kLevels)), ElementsAre(Bytes{'A', 2, 1, 1}));
  EXPECT_EQ(bench.duties(), kMeasured);
}

}  // namespace
}  // namespace vestige::test
