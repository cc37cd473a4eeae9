#include "transport/sinks/serial_sink.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/test_data.hpp"
#include "tests/transport/sinks/driver.hpp"
#include "tests/transport/sinks/fake_board.hpp"
#include "tests/transport/sinks/pseudo_terminal.hpp"
#include "tests/transport/wire/wire_answers.hpp"

namespace vestige {
namespace {

using std::chrono::milliseconds;
using test::Bytes;
using test::FakeBoard;
using test::PseudoTerminal;
using ::testing::AllOf;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

const Bytes kZeroAndHello{0x00, 0x02, 0x48, 0x03, 0x6A, 0x99, 0x00};

/// Waits for nothing that the tests do not bring about themselves.
SerialSinkOptions quick(const std::string& path) {
  SerialSinkOptions options;
  options.path = path;
  options.boot_silence = milliseconds(20);
  options.hello_interval = milliseconds(10);
  options.greeting_timeout = std::chrono::seconds(10);
  return options;
}

/// The answers up to that many, or what came within five seconds of nothing.
std::vector<Acknowledgement> receive_all(SerialSink& sink, std::size_t count) {
  std::vector<Acknowledgement> all;
  while (all.size() < count) {
    pollfd line{.fd = sink.readable_descriptor(), .events = POLLIN, .revents = 0};
    if (::poll(&line, 1, 5000) <= 0) break;
    const std::vector<Acknowledgement> more = sink.receive();
    all.insert(all.end(), more.begin(), more.end());
  }
  return all;
}

/// Takes whatever comes until there is a greeting, for five seconds at most.
std::optional<Greeting> receive_greeting(SerialSink& sink) {
  while (!sink.greeting()) {
    pollfd line{.fd = sink.readable_descriptor(), .events = POLLIN, .revents = 0};
    if (::poll(&line, 1, 5000) <= 0) break;
    sink.receive();
  }
  return sink.greeting();
}

ActuatorFrame duties(std::vector<std::uint8_t> duty) {
  return {.time_s = 0, .duty = std::move(duty)};
}

/// When the hello has left.
bool becomes_ready(SerialSink& sink) {
  for (int i = 0; i < 1000 && !sink.ready(); ++i) ::poll(nullptr, 0, 1);
  return sink.ready();
}

TEST(SerialSink, EndsWhatStandsOnTheLineAndSaysHelloWhenItOpens) {
  const PseudoTerminal line;
  const SerialSink sink(quick(line.path()));
  EXPECT_EQ(line.read_exactly(kZeroAndHello.size()), kZeroAndHello);
  EXPECT_EQ(sink.bytes_sent(), kZeroAndHello.size());
  EXPECT_EQ(sink.name(), line.path());
  EXPECT_TRUE(sink.acknowledges());
}

TEST(SerialSink, LearnsWhoIsThere) {
  const FakeBoard board;
  SerialSink sink(quick(board.path()));
  const std::optional<Greeting> greeting = sink.greet();
  ASSERT_TRUE(greeting.has_value());
  EXPECT_EQ(greeting->version, 3);
  EXPECT_EQ(greeting->actuator_count, 6);
  EXPECT_TRUE(greeting->was_in_fail_safe);
}

TEST(SerialSink, GreetsABoardThatIsLongInItsBootloader) {
  const FakeBoard board({.deaf_to_hellos = 4});
  SerialSink sink(quick(board.path()));
  EXPECT_TRUE(sink.greet().has_value());
  const std::vector<Bytes> heard = board.heard();
  EXPECT_GE(heard.size(), 4U);
  EXPECT_THAT(heard, Each(Bytes{'H', 0}));
}

TEST(SerialSink, GoesOnWithoutABoardThatSaysNothing) {
  const PseudoTerminal line;
  SerialSinkOptions options = quick(line.path());
  options.greeting_timeout = milliseconds(60);
  SerialSink sink(options);
  EXPECT_FALSE(sink.greet().has_value());
  EXPECT_TRUE(becomes_ready(sink));
  line.read_exactly(sink.bytes_sent());
  sink.send(duties({9}), 1);
  EXPECT_EQ(line.read_exactly(9), encode_state(Quantity::kDuty, Bytes{9}, 1, 20));
}

TEST(SerialSink, SaysNothingWhileABootloaderMayTakeItForAProgramUnlessTheBoardAnswers) {
  const PseudoTerminal line;
  SerialSinkOptions options = quick(line.path());
  options.boot_silence = std::chrono::hours(1);
  options.greeting_timeout = milliseconds(50);
  SerialSink sink(options);
  EXPECT_FALSE(sink.ready());
  line.write(test::greeting(0, 1, 6, 0));
  ASSERT_TRUE(receive_greeting(sink).has_value());
  EXPECT_TRUE(becomes_ready(sink));

  const PseudoTerminal silent;
  options.path = silent.path();
  SerialSink other(options);
  EXPECT_FALSE(other.greet().has_value());
  EXPECT_EQ(silent.read_exactly(kZeroAndHello.size()), kZeroAndHello);
  EXPECT_TRUE(silent.read(20).empty()) << "a second hello within the silence";
}

TEST(SerialSink, SendsDutiesAndIsAnswered) {
  const FakeBoard board;
  SerialSink sink(quick(board.path()));
  ASSERT_TRUE(sink.greet().has_value());
  const std::uint64_t before = sink.bytes_sent();
  for (std::uint8_t sequence = 1; sequence <= 50; ++sequence)
    sink.send(duties({0, 51, 102, 153, 204, sequence}), sequence);
  EXPECT_EQ(sink.bytes_sent() - before, 50U * 14U);
  sink.send_off(51);
  const std::vector<Acknowledgement> answers = receive_all(sink, 51);
  ASSERT_EQ(answers.size(), 51U);
  for (std::size_t i = 0; i < answers.size(); ++i) EXPECT_EQ(answers[i].sequence, i + 1);
  const std::vector<Bytes> heard = board.heard();
  EXPECT_EQ(heard[heard.size() - 2], (Bytes{'S', 50, 20, 6, 0, 51, 102, 153, 204, 50}));
  EXPECT_EQ(heard.back(), (Bytes{'X', 51, 0, 0}));
  EXPECT_EQ(sink.damaged_answers(), 0U);
}

TEST(SerialSink, SendsPressuresToAPneumaticVestWithTheTtlThatWasChosen) {
  const FakeBoard board;
  SerialSinkOptions options = quick(board.path());
  options.quantity = Quantity::kPressure;
  options.ttl_ms = 2550;
  SerialSink sink(options);
  ASSERT_TRUE(sink.greet().has_value());
  sink.send(duties({1, 2}), 9);
  ASSERT_EQ(receive_all(sink, 1).size(), 1U);
  EXPECT_EQ(board.heard().back(), (Bytes{'P', 9, 255, 2, 1, 2}));
}

TEST(SerialSink, RefusesATtlThatTheFrameCannotSay) {
  const PseudoTerminal line;
  for (const int ttl_ms : {-10, 0, 9, 205, 2551, 2560}) {
    SerialSinkOptions options = quick(line.path());
    options.ttl_ms = ttl_ms;
    EXPECT_THROW(SerialSink{options}, UsageError) << ttl_ms;
  }
}

TEST(SerialSink, LeavesOutActuatorsThatTheBoardDoesNotHave) {
  const FakeBoard board;
  SerialSink sink(quick(board.path()));
  ASSERT_TRUE(sink.greet().has_value());
  sink.send(duties({1, 2, 3, 4, 5, 6, 7, 8}), 1);
  sink.send(duties(std::vector<std::uint8_t>(1000, 5)), 2);
  ASSERT_EQ(receive_all(sink, 2).size(), 2U);
  const std::vector<Bytes> heard = board.heard();
  EXPECT_EQ(heard[heard.size() - 2], (Bytes{'S', 1, 20, 6, 1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(heard.back(), (Bytes{'S', 2, 20, 6, 5, 5, 5, 5, 5, 5}));
}

TEST(SerialSink, HearsAcknowledgementsInPiecesAndThroughGarbage) {
  const PseudoTerminal line;
  SerialSink sink(quick(line.path()));
  const Bytes first = test::acknowledgement(1, 1, 2);
  for (const std::uint8_t byte : first) {
    EXPECT_TRUE(sink.receive().empty());
    line.write(Bytes{byte});
  }
  std::vector<Acknowledgement> answers = receive_all(sink, 1);
  ASSERT_EQ(answers.size(), 1U);
  EXPECT_EQ(answers[0].sequence, 1);
  EXPECT_TRUE(answers[0].was_in_fail_safe);
  EXPECT_EQ(answers[0].receive_errors, 2);

  line.write(test::acknowledgement(2, 0, 2));
  line.write(Bytes{0x55, 0xFF, 0x55, 0x00, 0x00, 0x07, 0x41, 0x00});
  line.write(test::acknowledgement(3, 2, 2));
  answers = receive_all(sink, 2);
  ASSERT_EQ(answers.size(), 2U);
  EXPECT_EQ(answers[0].sequence, 2);
  EXPECT_EQ(answers[1].sequence, 3);
  EXPECT_TRUE(answers[1].overrun);
  EXPECT_EQ(sink.damaged_answers(), 2U);
}

TEST(SerialSink, IsNotReadyWhileAFrameIsPendingInTheSystem) {
  const PseudoTerminal line;
  SerialSinkOptions options = quick(line.path());
  options.baud = 4'000'000;  // all has left in a millisecond
  SerialSink sink(options);
  line.write(test::greeting(0, 1, 6, 0));
  ASSERT_TRUE(receive_greeting(sink).has_value());
  sink.send(duties({1, 2, 3, 4, 5, 6}), 1);
  ::poll(nullptr, 0, 1);
  test::Driver driver;
  EXPECT_TRUE(becomes_ready(sink));
  for (const int pending : {1, 14, 4000}) {
    driver.pending_bytes = pending;
    EXPECT_FALSE(sink.ready()) << pending;
  }
  driver.pending_bytes = 0;
}

TEST(SerialSink, IsNotReadyWhileAFrameCannotHaveLeftWhateverTheDriverCounts) {
  const PseudoTerminal line;
  SerialSinkOptions options = quick(line.path());
  options.baud = 50;  // 2.8 s a frame
  SerialSink sink(options);
  line.write(test::greeting(0, 1, 6, 0));
  ASSERT_TRUE(receive_greeting(sink).has_value());
  sink.send(duties({1, 2, 3, 4, 5, 6}), 1);
  EXPECT_FALSE(sink.ready());
}

TEST(SerialSink, ComesBackAfterItWasUnplugged) {
  const test::TemporaryFolder folder;
  const std::filesystem::path path = folder / "vest";
  auto first = std::make_unique<FakeBoard>();
  std::filesystem::create_symlink(first->path(), path);
  SerialSink sink(quick(path));
  ASSERT_TRUE(sink.greet().has_value());
  EXPECT_TRUE(sink.reconnect()) << "there is nothing to do";

  std::filesystem::remove(path);
  first.reset();
  pollfd line{.fd = sink.readable_descriptor(), .events = POLLIN, .revents = 0};
  EXPECT_EQ(::poll(&line, 1, 5000), 1) << "who waits for answers hears of it";
  EXPECT_THROW(
      {
        for (int i = 0; i < 3; ++i) sink.receive();  // a late answer may come first
      },
      LinkLost);
  EXPECT_EQ(sink.readable_descriptor(), -1);
  EXPECT_TRUE(becomes_ready(sink)) << "so that sending tells";
  EXPECT_THROW(sink.send(duties({1}), 1), LinkLost);
  EXPECT_THROW(sink.send_off(1), LinkLost);
  EXPECT_THROW(sink.receive(), LinkLost);
  EXPECT_FALSE(sink.reconnect()) << "it is not there yet";

  const FakeBoard second;
  std::filesystem::create_symlink(second.path(), path);
  ASSERT_TRUE(sink.reconnect());
  EXPECT_FALSE(sink.greeting().has_value()) << "this may be another board";
  ASSERT_TRUE(receive_greeting(sink).has_value());
  EXPECT_TRUE(becomes_ready(sink));
  sink.send(duties({7}), 5);
  EXPECT_EQ(receive_all(sink, 1).size(), 1U);
  EXPECT_EQ(second.heard().back(), (Bytes{'S', 5, 20, 1, 7}));
}

TEST(SerialSink, LosesTheLinkWhenSendingFindsItGone) {
  PseudoTerminal line;
  SerialSink sink(quick(line.path()));
  line.unplug();
  EXPECT_THROW(sink.send_off(1), LinkLost);
  EXPECT_EQ(sink.readable_descriptor(), -1);
  EXPECT_THROW(sink.greet(), LinkLost);
}

TEST(SerialSink, AsksABoardOnceMoreThatWasStartingWhenItWasPluggedInAgain) {
  const test::TemporaryFolder folder;
  const std::filesystem::path path = folder / "vest";
  PseudoTerminal first;
  std::filesystem::create_symlink(first.path(), path);
  SerialSink sink(quick(path));
  first.unplug();
  EXPECT_THROW(sink.send_off(1), LinkLost);
  std::filesystem::remove(path);
  const PseudoTerminal second;
  std::filesystem::create_symlink(second.path(), path);
  ASSERT_TRUE(sink.reconnect());
  EXPECT_EQ(second.read_exactly(kZeroAndHello.size()), kZeroAndHello);
  sink.send(duties({1}), 1);
  sink.send(duties({2}), 2);
  Bytes expected = kZeroAndHello;
  for (const std::uint8_t duty : Bytes{1, 2}) {
    const Bytes frame = encode_state(Quantity::kDuty, Bytes{duty}, duty, 20);
    expected.insert(expected.end(), frame.begin(), frame.end());
  }
  EXPECT_EQ(second.read_exactly(expected.size()), expected);
}

TEST(SerialSink, LeavesABusyPortToItsOwner) {
  const FakeBoard board;
  const SerialSink owner(quick(board.path()));
  try {
    const SerialSink second(quick(board.path()));
    FAIL() << "two programs speak at once";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("busy"), HasSubstr("fuser")));
  }
}

/// What a radio puts out at the vest, of all that its module was given: the payloads one after another.
Bytes over_the_air(const Bytes& given, const XbeeOptions& options) {
  const std::size_t header = options.request == XbeeRequest::kTransmit ? 14 : 5;
  Bytes plain;
  for (std::size_t i = 0; i < given.size(); ++i) {
    if (options.escaping == XbeeEscaping::kEscaped && given[i] == 0x7D && i + 1 < given.size())
      plain.push_back(static_cast<std::uint8_t>(given[++i] ^ 0x20U));
    else
      plain.push_back(given[i]);
  }
  Bytes heard;
  for (std::size_t at = 0; at + 3 < plain.size() && plain[at] == 0x7E;) {
    const std::size_t length = plain[at + 1] * 256U + plain[at + 2];
    if (at + 3 + length >= plain.size()) break;
    heard.insert(heard.end(), plain.begin() + static_cast<std::ptrdiff_t>(at + 3 + header),
                 plain.begin() + static_cast<std::ptrdiff_t>(at + 3 + length));
    at += 3 + length + 1;
  }
  return heard;
}

Bytes api_frame(const Bytes& data, XbeeEscaping escaping) {
  unsigned sum = 0;
  for (const std::uint8_t byte : data) sum += byte;
  Bytes plain{0, static_cast<std::uint8_t>(data.size())};
  plain.insert(plain.end(), data.begin(), data.end());
  plain.push_back(static_cast<std::uint8_t>(0xFF - (sum & 0xFFU)));
  Bytes frame{0x7E};
  for (const std::uint8_t byte : plain) {
    if (escaping == XbeeEscaping::kEscaped && (byte == 0x7E || byte == 0x7D || byte == 0x11 || byte == 0x13))
      frame.insert(frame.end(), {0x7D, static_cast<std::uint8_t>(byte ^ 0x20U)});
    else
      frame.push_back(byte);
  }
  return frame;
}

TEST(SerialSink, DrivesAVestThroughRadiosInApiMode) {
  for (const XbeeRequest request : {XbeeRequest::kTransmit, XbeeRequest::kTx16}) {
    for (const XbeeEscaping escaping : {XbeeEscaping::kNone, XbeeEscaping::kEscaped}) {
      const XbeeOptions radio{.request = request, .escaping = escaping, .address = 0x7E13};
      FakeBoard::Options board_options;
      board_options.unwrap = [=](const Bytes& given) { return over_the_air(given, radio); };
      board_options.wrap = [=](const Bytes& answer) {
        const bool is_new = radio.request == XbeeRequest::kTransmit;
        const Bytes status = is_new ? Bytes{0x8B, 1, 0x7E, 0x13, 0, 0, 0} : Bytes{0x89, 1, 0};
        Bytes received = is_new ? Bytes{0x90, 0, 0x13, 0xA2, 0, 0x40, 0x52, 0x2B, 0xAA, 0x7E, 0x13, 1}
                                : Bytes{0x81, 0x7E, 0x13, 0x28, 0};
        received.insert(received.end(), answer.begin(), answer.end());
        Bytes line = api_frame(status, radio.escaping);
        const Bytes second = api_frame(received, radio.escaping);
        line.insert(line.end(), second.begin(), second.end());
        return line;
      };
      const FakeBoard board(std::move(board_options));
      SerialSinkOptions options = quick(board.path());
      options.xbee = radio;
      SerialSink sink(options);
      const std::optional<Greeting> greeting = sink.greet();
      ASSERT_TRUE(greeting.has_value());
      EXPECT_EQ(greeting->actuator_count, 6);
      for (std::uint8_t sequence = 1; sequence <= 130; ++sequence)
        sink.send(duties({0x7E, 0x7D, 0x11, 0x13, sequence, 255}), sequence);
      const std::vector<Acknowledgement> answers = receive_all(sink, 130);
      ASSERT_EQ(answers.size(), 130U);
      for (std::size_t i = 0; i < answers.size(); ++i) EXPECT_EQ(answers[i].sequence, i + 1);
      EXPECT_EQ(board.heard().back(), (Bytes{'S', 130, 20, 6, 0x7E, 0x7D, 0x11, 0x13, 130, 255}));
      ASSERT_NE(sink.radio(), nullptr);
      EXPECT_EQ(sink.radio()->delivered(), board.heard().size());
      EXPECT_EQ(sink.radio()->undelivered() + sink.radio()->damaged() + sink.damaged_answers(), 0U);
    }
  }
}

}  // namespace
}  // namespace vestige
