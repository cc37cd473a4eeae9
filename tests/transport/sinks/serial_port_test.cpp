#include "transport/sinks/serial_port.hpp"

#include <gmock/gmock.h>
#include <grp.h>
#include <gtest/gtest.h>
#include <linux/serial.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <termios.h>

#include <cstring>
#include <fstream>
#include <functional>
#include <numeric>
#include <thread>

#include "tests/support/test_data.hpp"
#include "tests/transport/sinks/driver.hpp"
#include "tests/transport/sinks/pseudo_terminal.hpp"
#include "traces/files/input_file.hpp"
#include "transport/actuator_sink.hpp"

namespace vestige {
namespace {

using test::PseudoTerminal;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using Bytes = std::vector<std::uint8_t>;

/// What opening says; empty when it succeeds.
std::string refusal(const std::string& path, std::uint32_t baud = kDefaultBaud) {
  try {
    const SerialPort port(path, baud);
    return "";
  } catch (const Error& error) {
    return error.what();
  }
}

/// What `question` says in a process of a user who owns nothing.
std::string as_nobody(const std::function<std::string()>& question) {
  std::array<int, 2> ends{};
  if (::pipe(ends.data()) != 0) return "no pipe";
  const pid_t child = ::fork();
  if (child == 0) {
    constexpr uid_t kNobody = 65534;
    const bool dropped = ::setgroups(0, nullptr) == 0 && ::setgid(kNobody) == 0 && ::setuid(kNobody) == 0;
    const std::string answer = dropped ? question() : "still root";
    const ssize_t written = ::write(ends[1], answer.data(), answer.size());
    ::_exit(written < 0 ? 1 : 0);
  }
  ::close(ends[1]);
  std::string answer;
  std::array<char, 4096> piece{};
  for (ssize_t count = 0; (count = ::read(ends[0], piece.data(), piece.size())) > 0;)
    answer.append(piece.data(), static_cast<std::size_t>(count));
  ::close(ends[0]);
  ::waitpid(child, nullptr, 0);
  return answer;
}

Bytes every_byte() {
  Bytes bytes(256);
  std::iota(bytes.begin(), bytes.end(), std::uint8_t{0});
  return bytes;
}

Bytes read_exactly(SerialPort& port, std::size_t count) {
  Bytes bytes;
  while (bytes.size() < count && port.wait_readable(std::chrono::seconds(5))) {
    const Bytes more = port.read();
    bytes.insert(bytes.end(), more.begin(), more.end());
  }
  return bytes;
}

TEST(SerialPort, CarriesEveryByteUnchangedBothWays) {
  const PseudoTerminal line;
  SerialPort port(line.path(), kDefaultBaud);
  port.write(every_byte());
  EXPECT_EQ(line.read_exactly(256), every_byte());
  line.write(every_byte());
  EXPECT_EQ(read_exactly(port, 256), every_byte());
  EXPECT_TRUE(port.read().empty()) << "nothing has come, and the line is whole";
  EXPECT_FALSE(port.wait_readable(std::chrono::milliseconds(1)));
}

TEST(SerialPort, SetsTheLineAndKeepsTheBoardFromResettingAtTheNextOpening) {
  const PseudoTerminal line;
  const int descriptor = ::open(line.path().c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
  termios settings{};
  ASSERT_EQ(::tcgetattr(descriptor, &settings), 0);
  settings.c_cflag |= HUPCL | CSTOPB | CRTSCTS;
  settings.c_cflag &= ~tcflag_t{CLOCAL};
  ASSERT_EQ(::tcsetattr(descriptor, TCSANOW, &settings), 0);
  for (const auto& [baud, constant] : {std::pair(kDefaultBaud, B57600), std::pair(9600U, B9600)}) {
    { const SerialPort port(line.path(), baud); }
    ASSERT_EQ(::tcgetattr(descriptor, &settings), 0);
    EXPECT_EQ(::cfgetospeed(&settings), constant);
    EXPECT_EQ(settings.c_cflag & (HUPCL | CRTSCTS | CSTOPB | PARENB), 0U);
    EXPECT_EQ(settings.c_cflag & (CSIZE | CLOCAL | CREAD), tcflag_t{CS8 | CLOCAL | CREAD});
  }
  ::close(descriptor);
}

TEST(SerialPort, DropsWhatCameBeforeItWasOpened) {
  const PseudoTerminal line;
  { const SerialPort sets_raw(line.path(), kDefaultBaud); }
  const int holds_it_open = ::open(line.path().c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
  line.write(Bytes{1, 2, 3});
  SerialPort port(line.path(), kDefaultBaud);
  line.write(Bytes{4});
  EXPECT_THAT(read_exactly(port, 1), ElementsAre(4));
  ::close(holds_it_open);
}

TEST(SerialPort, LosesNothingWhenItIsClosedAtOnce) {
  const PseudoTerminal line;
  {
    SerialPort port(line.path(), kDefaultBaud);
    port.write(every_byte());
  }
  EXPECT_EQ(line.read_exactly(256), every_byte());
}

TEST(SerialPort, AsksTheDriverForLowLatencyAndLeavesItsOtherFlags) {
  const PseudoTerminal line;
  test::Driver driver;
  driver.has_serial_flags = true;
  driver.serial_flags = ASYNC_SKIP_TEST;
  const SerialPort port(line.path(), kDefaultBaud);
  EXPECT_EQ(driver.serial_flags, static_cast<int>(ASYNC_SKIP_TEST | ASYNC_LOW_LATENCY));
}

TEST(SerialPort, SaysThatThereIsNoSuchDeviceAndWhichThereAre) {
  const test::TemporaryFolder folder;
  EXPECT_THAT(refusal(folder / "ttyUSB0"),
              AllOf(HasSubstr("ttyUSB0: there is no such device"), HasSubstr("serial port")));
}

TEST(SerialPort, ListsThePortsThatAVestMayHangOn) {
  const test::TemporaryFolder folder;
  for (const char* name : {"ttyUSB0", "ttyACM1", "tty1", "null", "ttyS999", "ptmx", "rfcomm0"})
    std::ofstream(folder / name) << "";
  EXPECT_THAT(serial_candidates(folder.path()),
              ElementsAre(EndsWith("/rfcomm0"), EndsWith("/ttyACM1"), EndsWith("/ttyS999"), EndsWith("/ttyUSB0")));
  EXPECT_TRUE(serial_candidates(folder / "absent").empty());
}

TEST(SerialPort, RefusesWhatIsNoSerialDevice) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "file") << "precious";
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  for (const std::string& path :
       {(folder / "file").string(), (folder / "pipe").string(), folder.path().string(), std::string("/dev/null")})
    EXPECT_THAT(refusal(path), HasSubstr(path + ": this is not a serial device"));
  EXPECT_EQ(read_text_file(folder / "file"), "precious");
}

TEST(SerialPort, IsBusyForASecondOpenerUntilItIsClosed) {
  const PseudoTerminal line;
  {
    const SerialPort port(line.path(), kDefaultBaud);
    EXPECT_THAT(refusal(line.path()), AllOf(HasSubstr(line.path() + ": busy"), HasSubstr("fuser -v " + line.path())));
  }
  EXPECT_EQ(refusal(line.path()), "");
}

TEST(SerialPort, IsBusyForProgramsOfOtherUsersThatKnowNoLocks) {
  if (::getuid() != 0) GTEST_SKIP() << "only root can become somebody else";
  const PseudoTerminal line;
  ASSERT_EQ(::chmod(line.path().c_str(), 0666), 0);
  const auto plain_open = [&] {
    const int descriptor = ::open(line.path().c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
    return descriptor < 0 ? std::string(std::strerror(errno)) : "opened";
  };
  {
    const SerialPort port(line.path(), kDefaultBaud);
    EXPECT_EQ(as_nobody(plain_open), std::strerror(EBUSY));
    EXPECT_THAT(as_nobody([&] { return refusal(line.path()); }), HasSubstr(": busy"));
  }
  // The terminal remembers who may open it as long as anybody has it open.
  const int holds_it_open = ::open(line.path().c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
  {
    const SerialPort port(line.path(), kDefaultBaud);
    EXPECT_EQ(as_nobody(plain_open), std::strerror(EBUSY));
  }
  EXPECT_EQ(as_nobody(plain_open), "opened");
  ::close(holds_it_open);
}

TEST(SerialPort, NamesTheGroupToJoinForThePermission) {
  if (::getuid() != 0) GTEST_SKIP() << "only root can become somebody else";
  const PseudoTerminal line;
  const group* dialout = ::getgrnam("dialout");
  ASSERT_NE(dialout, nullptr);
  ASSERT_EQ(::chown(line.path().c_str(), 0, dialout->gr_gid), 0);
  ASSERT_EQ(::chmod(line.path().c_str(), 0660), 0);
  EXPECT_THAT(as_nobody([&] { return refusal(line.path()); }),
              AllOf(HasSubstr(line.path() + ": you have no permission to open this port"),
                    HasSubstr("sudo usermod -aG dialout $USER")));
}

TEST(SerialPort, AdvisesNobodyToJoinAGroupThatHelpsNothingOrIsRoots) {
  if (::getuid() != 0) GTEST_SKIP() << "only root can become somebody else";
  const PseudoTerminal line;
  const auto expect_chown = [&] {
    EXPECT_THAT(as_nobody([&] { return refusal(line.path()); }),
                AllOf(HasSubstr("sudo chown $USER " + line.path()), ::testing::Not(HasSubstr("usermod"))));
  };
  const group* dialout = ::getgrnam("dialout");
  ASSERT_NE(dialout, nullptr);
  ASSERT_EQ(::chown(line.path().c_str(), 0, dialout->gr_gid), 0);
  ASSERT_EQ(::chmod(line.path().c_str(), 0620), 0);
  expect_chown();
  ASSERT_EQ(::chown(line.path().c_str(), 0, 0), 0);
  ASSERT_EQ(::chmod(line.path().c_str(), 0660), 0);
  expect_chown();
}

TEST(SerialPort, RefusesABaudThatIsNoneAndListsThoseThatAre) {
  const PseudoTerminal line;
  EXPECT_THAT(refusal(line.path(), 57601),
              AllOf(HasSubstr("--baud: 57601 is not a standard rate"), HasSubstr(" 38400, 57600, 115200, ")));
  EXPECT_THROW(SerialPort(line.path(), 0), UsageError);
}

TEST(SerialPort, NoticesADriverThatSetsAnotherBaud) {
  const PseudoTerminal line;
  test::Driver driver;
  driver.only_9600_baud = true;
  EXPECT_THAT(refusal(line.path(), 57600), HasSubstr("refuses 57600 baud"));
  EXPECT_EQ(refusal(line.path(), 9600), "");
}

TEST(SerialPort, TellsWhenTheDeviceIsGone) {
  PseudoTerminal line;
  SerialPort port(line.path(), kDefaultBaud);
  line.write(Bytes{1, 2});
  ASSERT_TRUE(port.wait_readable(std::chrono::seconds(5)));
  line.unplug();
  EXPECT_TRUE(port.wait_readable(std::chrono::seconds(5)));
  EXPECT_THROW(
      {
        port.read();  // what had come before may be lost with the device
        port.read();
      },
      LinkLost);
  EXPECT_THROW(port.write(Bytes{1}), LinkLost);
  EXPECT_EQ(port.pending_bytes(), 0U);
}

TEST(SerialPort, GivesALineUpThatTakesNothingAnyMore) {
  const PseudoTerminal line;
  SerialPort port(line.path(), kDefaultBaud, std::chrono::milliseconds(30));
  const Bytes much(1 << 20, 0x55);
  try {
    port.write(much);
    FAIL() << "nobody reads, and yet all was taken";
  } catch (const LinkLost& error) {
    EXPECT_THAT(error.what(), HasSubstr("within 30 ms"));
  }
}

TEST(SerialPort, WritesInPiecesToALineThatIsSlow) {
  const PseudoTerminal line;
  SerialPort port(line.path(), kDefaultBaud, std::chrono::minutes(1));
  Bytes much(200'000);
  std::iota(much.begin(), much.end(), std::uint8_t{0});
  Bytes taken;
  std::thread reader([&] {
    while (taken.size() < much.size()) {
      const Bytes more = line.read(5000);
      if (more.empty()) break;
      taken.insert(taken.end(), more.begin(), more.end());
    }
  });
  port.write(much);
  reader.join();
  EXPECT_EQ(taken, much);
}

}  // namespace
}  // namespace vestige
