#include "tests/transport/firmware/simulated_board.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <sstream>
#include <string>
#include <thread>

#include "tests/support/background_process.hpp"
#include "tests/support/process.hpp"
#include "tests/support/wire_frames.hpp"
#include "tests/transport/firmware/pin_duty.hpp"
#include "traces/base/error.hpp"

// The board as a program, used as a client uses a serial port. Nothing here depends on how fast the machine is.
namespace vestige::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::string firmware() {
  return (std::filesystem::path(VESTIGE_FIRMWARE_DIR) / "vest-atmega1280.elf").string();
}

/// A client that leaves the terminal's settings as they are.
class Client {
 public:
  explicit Client(const std::string& terminal) : descriptor_(::open(terminal.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC)) {
    EXPECT_GE(descriptor_, 0) << terminal << ": " << std::strerror(errno);
  }
  ~Client() { ::close(descriptor_); }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  void send(const Bytes& bytes) const {
    EXPECT_EQ(::write(descriptor_, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  }
  /// The next frame's payload; empty when none comes for ten seconds.
  Bytes answer() const {
    Bytes line;
    std::uint8_t byte = 1;
    pollfd readable{descriptor_, POLLIN, 0};
    while (byte != 0 && ::poll(&readable, 1, 10'000) == 1 && ::read(descriptor_, &byte, 1) == 1) line.push_back(byte);
    const auto payloads = wire_payloads(line);
    return payloads.size() == 1 ? payloads[0] : Bytes{};
  }
  Bytes answer_to(const Bytes& bytes) const {
    send(bytes);
    return answer();
  }
  int unread() const {
    int count = -1;
    ::ioctl(descriptor_, FIONREAD, &count);
    return count;
  }
  void lock() const { EXPECT_EQ(::ioctl(descriptor_, TIOCEXCL), 0); }

 private:
  int descriptor_;
};

class SimulatedBoardTest : public ::testing::Test {
 protected:
  static void short_sleep() { std::this_thread::sleep_for(std::chrono::milliseconds(10)); }
  /// Whether the terminal can be opened and has nothing to read.
  bool is_like_new() const {
    const int descriptor = ::open(terminal.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
    int unread = -1;
    ::ioctl(descriptor, FIONREAD, &unread);
    ::close(descriptor);
    return unread == 0;
  }
  /// Ends the board, which must not have failed, and reads what it has measured.
  std::vector<DutyRow> measured() {
    board.signal(SIGTERM);
    EXPECT_EQ(board.wait(), 0) << read_text_file(folder / "err");
    std::istringstream text(read_text_file(folder / "duties.csv"));
    std::string line;
    std::getline(text, line);
    EXPECT_EQ(line, "time_s,actuator_1,actuator_2,actuator_3,actuator_4,actuator_5,actuator_6");
    std::vector<DutyRow> rows;
    while (std::getline(text, line)) {
      std::istringstream fields(line);
      DutyRow row{0, std::vector<std::uint8_t>(6)};
      fields >> row.time_s;
      for (std::uint8_t& duty : row.duty) {
        char comma = 0;
        unsigned value = 0;
        fields >> comma >> value;
        duty = static_cast<std::uint8_t>(value);
      }
      rows.push_back(row);
    }
    return rows;
  }

  const TemporaryFolder folder;
  BackgroundProcess board{{"simulated_board", firmware(), "--duties", (folder / "duties.csv").string(), "--link",
                           (folder / "vest").string()},
                          folder / "err"};
  const std::string terminal = board.line();
};

TEST_F(SimulatedBoardTest, IsATerminalBehindWhichTheFirmwareAnswers) {
  EXPECT_THAT(terminal, ::testing::StartsWith("/dev/pts/"));
  EXPECT_EQ(std::filesystem::read_symlink(folder / "vest"), terminal);
  {
    const Client client(folder / "vest");
    EXPECT_THAT(client.answer_to(hello_frame(5)), ElementsAre('H', 5, 1, 6, 1));
    EXPECT_THAT(client.answer_to(levels_frame('S', 6, 255, {10, 20, 30, 40, 50, 255})), ElementsAre('A', 6, 0, 0));
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    EXPECT_THAT(client.answer_to(off_frame(7)), ElementsAre('A', 7, 0, 0));
  }
  const auto rows = measured();
  EXPECT_THAT(rows.front().duty, ElementsAre(0, 0, 0, 0, 0, 0));
  EXPECT_EQ(rows.front().time_s, 0);
  EXPECT_THAT(rows, ::testing::Contains(::testing::Field(&DutyRow::duty, ElementsAre(10, 20, 30, 40, 50, 255))));
  EXPECT_THAT(rows.back().duty, ElementsAre(0, 0, 0, 0, 0, 0));
  EXPECT_FALSE(std::filesystem::is_symlink(folder / "vest"));
}

TEST_F(SimulatedBoardTest, ChangesNoByteOnTheWay) {
  const Client client(terminal);
  // What a terminal that is not raw would make something else of: line ends, end of file, interrupt, flow control,
  // erase.
  for (const std::uint8_t sequence : Bytes{3, 4, 8, 10, 13, 17, 19, 21, 22, 23, 26, 28, 127, 255}) {
    EXPECT_THAT(client.answer_to(off_frame(sequence)), ElementsAre('A', sequence, ::testing::_, 0));
  }
}

TEST_F(SimulatedBoardTest, OutlivesClientsTheirLocksAndWhatTheyLeaveUnread) {
  for (std::uint8_t i = 0; i < 3; ++i) {
    {
      const Client client(terminal);
      client.lock();
      EXPECT_THAT(client.answer_to(hello_frame(i)), ElementsAre('H', i, 1, 6, i == 0 ? 1 : 0));
      client.send(off_frame(99));
      for (int tries = 0; tries < 1000 && client.unread() == 0; ++tries) short_sleep();
      EXPECT_GT(client.unread(), 0);
    }
    // A real line's driver is quicker than this one: it is done when the client's close returns.
    for (int tries = 0; tries < 1000 && !is_like_new(); ++tries) short_sleep();
    EXPECT_TRUE(is_like_new());
  }
}

TEST_F(SimulatedBoardTest, DeliversWhatAClientWroteBeforeItLeft) {
  { Client(terminal).send(levels_frame('S', 1, 255, {77})); }
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_THAT(measured().back().duty, ElementsAre(77, 0, 0, 0, 0, 0));
}

TEST_F(SimulatedBoardTest, MotorsStopWithinTheirTimeToLiveWhenTheClientIsGone) {
  { Client(terminal).send(levels_frame('S', 1, 10, {255, 255, 255, 255, 255, 255})); }
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  const auto rows = measured();
  ASSERT_GE(rows.size(), 3U);
  EXPECT_THAT(rows.back().duty, ElementsAre(0, 0, 0, 0, 0, 0));
  EXPECT_LE(rows.back().time_s - rows[1].time_s, 0.11) << "in the board's own time";
}

TEST_F(SimulatedBoardTest, StartsAgainWithMotorsOffWhenItsPowerIsInterrupted) {
  const Client client(terminal);
  EXPECT_THAT(client.answer_to(hello_frame(1)), ElementsAre('H', 1, 1, 6, 1));
  EXPECT_THAT(client.answer_to(levels_frame('S', 2, 255, {100, 100, 100, 100, 100, 100})), ElementsAre('A', 2, 0, 0));
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  board.signal(SIGUSR1);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_THAT(client.answer_to(hello_frame(3)), ElementsAre('H', 3, 1, 6, 1)) << "it has just started";
  const auto rows = measured();
  EXPECT_THAT(rows.back().duty, ElementsAre(0, 0, 0, 0, 0, 0));
  EXPECT_THAT(read_text_file(folder / "err"), HasSubstr("2 starts"));
}

TEST(SimulatedBoardErrorsTest, SaysWhatItCannotRun) {
  const TemporaryFolder folder;
  const Outcome missing = run("simulated_board none.elf", folder.path());
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_THAT(missing.standard_error, HasSubstr("none.elf: there is no such file"));
  const Outcome foreign = run("simulated_board /bin/sh", folder.path());
  EXPECT_EQ(foreign.exit_code, 1);
  EXPECT_THAT(foreign.standard_error, HasSubstr("/bin/sh: this is no program for an AVR"));
  const Outcome unknown = run("simulated_board --mcu z80 '" + firmware() + "'", folder.path());
  EXPECT_EQ(unknown.exit_code, 1);
  EXPECT_THAT(unknown.standard_error, HasSubstr("does not know the microcontroller 'z80'"));
}

TEST(SimulatedBoardErrorsTest, SaysThatTheFirmwareIsForAnotherBoard) {
  const TemporaryFolder folder;
  const Outcome pins = run("simulated_board --chips 1 '" + firmware() + "'", folder.path());
  EXPECT_EQ(pins.exit_code, 1);
  EXPECT_THAT(pins.standard_error, HasSubstr("drives motors on pins, and the board has chips"));
  const std::string for_chips = std::filesystem::path(VESTIGE_FIRMWARE_DIR) / "vest-atmega1280-32.elf";
  const Outcome chips = run("simulated_board '" + for_chips + "'", folder.path());
  EXPECT_EQ(chips.exit_code, 1);
  EXPECT_THAT(chips.standard_error, HasSubstr("say how many it has: --chips N"));
}

TEST(SimulatedBoardErrorsTest, WritesTheDutiesOfAllItsChips) {
  const TemporaryFolder folder;
  const std::string for_chips = std::filesystem::path(VESTIGE_FIRMWARE_DIR) / "vest-atmega1280-64.elf";
  const Outcome outcome =
      run("simulated_board --chips 4 --duration 0.2 --duties d.csv '" + for_chips + "'", folder.path());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.standard_error;
  EXPECT_THAT(read_text_file(folder / "d.csv"), HasSubstr(",actuator_64\n0,0,0"));
}

TEST(SimulatedBoardErrorsTest, EndsAfterItsDuration) {
  const TemporaryFolder folder;
  const Outcome outcome = run("simulated_board --duration 0.2 --duties d.csv '" + firmware() + "'", folder.path());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.standard_error;
  EXPECT_THAT(read_text_file(folder / "d.csv"), ::testing::EndsWith("actuator_6\n0,0,0,0,0,0,0\n"));
  const Outcome again = run("simulated_board --duration 9 --duties d.csv '" + firmware() + "'", folder.path());
  EXPECT_EQ(again.exit_code, 1);
  EXPECT_THAT(again.standard_error, HasSubstr("already exists"));
}

TEST(SimulatedLineTest, TakesTheTimeOfARealOne) {
  SimulatedBoard board(firmware());
  board.run_for(0.01);
  const double before_s = board.time_s();
  board.send(Bytes(5760, 0));
  board.run_until_sent();
  EXPECT_NEAR(board.time_s() - before_s, 1, 1e-3);
}

TEST(SimulatedLineTest, RefusesASpeedThatTheFirmwareDoesNotListenAt) {
  SimulatedBoard board(firmware(), "", 115200);
  board.run_for(0.01);
  board.send(hello_frame(1));
  EXPECT_THAT([&] { board.run_for(0.1); },
              ::testing::ThrowsMessage<Error>(HasSubstr("it listens at 57142 baud, the line has 115200")));
}

TEST(PinDutyTest, CountsOnlyWholePeriods) {
  constexpr std::uint64_t kPeriod = PinDuty::kPeriod_cycles;
  PinDuty pin;
  const auto pulse = [&](const std::uint64_t start, const std::uint64_t length) {
    pin.set(start, true);
    pin.set(start + length, false);
  };
  pulse(5000, 100);  // cut short: the timer was in the middle of its period
  pulse(10000, 64 * 10);
  pulse(10000 + kPeriod, 64 * 10);
  pulse(10000 + 2 * kPeriod, 64 * 200);
  pulse(10000 + 3 * kPeriod, 64 * 200);
  pin.set(10000 + 4 * kPeriod, true);
  pin.advance(10000 + 6 * kPeriod);
  pin.set(10000 + 7 * kPeriod, false);
  pin.advance(10000 + 9 * kPeriod);
  EXPECT_THAT(pin.changes(), ElementsAre(DutyChange{0, 0}, DutyChange{10000, 10}, DutyChange{10000 + 2 * kPeriod, 200},
                                         DutyChange{10000 + 4 * kPeriod, 255}, DutyChange{10000 + 7 * kPeriod, 0}));
  EXPECT_EQ(pin.high_cycles(10000 + 9 * kPeriod), 100 + 64 * 420 + 3 * kPeriod);
}

}  // namespace
}  // namespace vestige::test
