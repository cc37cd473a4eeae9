// Streams traces as a user does, to a simulated board: the vest's own program on a simulated ATmega1280, behind a pty.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/command_line.hpp"

namespace vestige {
namespace {

using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::Not;

using Levels = std::vector<int>;

/// A row of a timeline, of a log, or of what the board's pins showed.
struct Row {
  double time_s = 0;
  std::string state;
  Levels level;
};

/// Skips the columns that are neither the time, nor the state, nor levels.
std::vector<Row> read_rows(const std::filesystem::path& file, std::size_t level_column) {
  std::ifstream stream(file);
  std::vector<Row> rows;
  std::string line;
  std::getline(stream, line);
  while (std::getline(stream, line)) {
    std::istringstream cells(line);
    Row row;
    std::string cell;
    for (std::size_t column = 0; std::getline(cells, cell, ','); ++column) {
      if (column == 0) row.time_s = std::stod(cell);
      if (column == 1 && level_column > 1) row.state = cell;
      if (column >= level_column) row.level.push_back(std::stoi(cell));
    }
    rows.push_back(row);
  }
  return rows;
}

std::vector<Row> read_timeline(const std::filesystem::path& file) {
  return read_rows(file, 1);
}
std::vector<Row> read_log(const std::filesystem::path& file) {
  return read_rows(file, 3);
}

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

class StreamCommand : public test::CommandLineTest {
 protected:
  void record(const std::string& flags) const {
    ASSERT_EQ(run("vestige record -q -o trace.mcap " + flags).exit_code, 0);
  }

  /// Runs `command` beside a board whose pty is called 'vest' and whose pins end up in pins.csv.
  test::Outcome run_with_board(const std::string& command, const std::string& firmware = "vest-atmega1280") const {
    return run("simulated_board '" VESTIGE_FIRMWARE_DIR "/" + firmware +
               ".elf' --link vest --duties pins.csv >board.txt 2>&1 & board=$!\n"
               "for i in $(seq 200); do [ -e vest ] && break; sleep 0.05; done\n" +
               command + "\ncode=$?; kill -INT $board; wait $board; exit $code");
  }
};

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

TEST_F(StreamCommand, AMapThatIsEditedWhileItIsFeltIsReadAgainAndABadOneIsNot) {
  record("--colliders hug --rate 100 --duration 0.5");
  // A map of one actuator everywhere, then of the second everywhere, then no map at all.
  const std::string make =
      "python3 -c \"import struct,zlib,sys\n"
      "def png(grey):\n"
      "  chunk=lambda n,d: struct.pack('>I',len(d))+n+d+struct.pack('>I',zlib.crc32(n+d))\n"
      "  return b'\\x89PNG\\r\\n\\x1a\\n'+chunk(b'IHDR',struct.pack('>IIBBBBB',1,1,8,0,0,0,0))"
      "+chunk(b'IDAT',zlib.compress(bytes([0,grey])))+chunk(b'IEND',b'')\n"
      "open(sys.argv[2],'wb').write(png(int(sys.argv[1])))\" ";
  ASSERT_EQ(
      run("echo '{\"actuators\": [{\"grey\": 10, \"name\": \"a\"}, {\"grey\": 20, \"name\": \"b\"}]}' >map.json\n" +
          make + "10 map.png")
          .exit_code,
      0);
  const test::Outcome outcome =
      run("vestige stream trace.mcap --port file:frames --map map.png --loop --log log.csv "
          "--json stream.json & stream=$!\nsleep 3\n" +
          make +
          "20 new.png; mv new.png map.png\nsleep 3\necho nonsense >map.png\nsleep 3\n"
          "kill -INT $stream; wait $stream");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.standard_error;
  EXPECT_EQ(json_in("stream.json")["maps_reloaded"], 1);
  EXPECT_THAT(outcome.standard_error, HasSubstr("map.png"));
  EXPECT_THAT(outcome.standard_error, HasSubstr("The previous map stays in use"));
  const std::vector<Row> log = read_log(folder_ / "log.csv");
  ASSERT_FALSE(log.empty());
  EXPECT_TRUE(std::ranges::any_of(log, [](const Row& row) { return row.level == Levels{255, 0}; }));
  EXPECT_EQ(log.back().level[0], 0);
  EXPECT_TRUE(std::ranges::any_of(log, [](const Row& row) { return row.level == Levels{0, 255}; }));
}

TEST_F(StreamCommand, FramesGoToStandardOutputAsTheyWouldGoDownTheWire) {
  record("--count 20 --rate 60 --duration 1");
  ASSERT_EQ(run("vestige stream trace.mcap --port - --rate 10 --json stream.json >frames.bin").exit_code, 0);
  std::ifstream stream(folder_ / "frames.bin", std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(stream)), {});
  ASSERT_GE(bytes.size(), 14U + 8U);
  EXPECT_EQ(bytes[1], 'S');
  EXPECT_EQ(bytes[13], '\0');
  EXPECT_EQ(bytes.back(), '\0');
  EXPECT_EQ(bytes[bytes.size() - 7], 'X');
  EXPECT_EQ(std::ranges::count(bytes, '\0'), json_in("stream.json")["sent"]);
  EXPECT_EQ(bytes.size(), json_in("stream.json")["link"]["bytes"]);
}

TEST_F(StreamCommand, ParametersGoByOscToWhoeverListens) {
  record("--colliders hug --rate 100 --duration 1");
  const test::Outcome outcome =
      run("python3 -c \"import socket\ns=socket.socket(socket.AF_INET,socket.SOCK_DGRAM)\ns.bind(('127.0.0.1',0))\n"
          "open('port.new','w').write(str(s.getsockname()[1]))\nimport os\nos.rename('port.new','port')\n"
          "s.settimeout(3)\nheard=open('heard','wb')\n"
          "try:\n  while True: heard.write(s.recv(65536))\nexcept TimeoutError: pass\" & listener=$!\n"
          "for i in $(seq 100); do [ -e port ] && break; sleep 0.05; done\n"
          "vestige stream trace.mcap --port osc://127.0.0.1:$(cat port) --osc-address '/vest/{n}' --json stream.json; "
          "code=$?; wait $listener; exit $code");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.standard_error;
  const std::string heard = read_text_file(folder_ / "heard");
  for (int motor = 1; motor <= 6; ++motor) EXPECT_THAT(heard, HasSubstr(fmt::format("/vest/{}", motor)));
  // Both ends of a motor's strength, as OSC's big-endian floats.
  EXPECT_THAT(heard, HasSubstr(std::string(",f\0\0\x3f\x80\0\0", 8)));
  EXPECT_THAT(heard, HasSubstr(std::string(",f\0\0\0\0\0\0", 8)));
  EXPECT_GT(json_in("stream.json")["sent"], 0);
  EXPECT_THAT(outcome.standard_error, Not(HasSubstr("no program listens")));
  // That listener has gone.
  const test::Outcome alone = run("vestige stream trace.mcap --port OSC://127.0.0.1:$(cat port)");
  EXPECT_EQ(alone.exit_code, 0) << alone.standard_error;
  EXPECT_THAT(alone.standard_error, HasSubstr("no program listens there now"));
}

TEST_F(StreamCommand, AnXbeeInApiModeGetsItsFrames) {
  record("--colliders hug --rate 100 --duration 0.5");
  // A radio that nobody answers through: what it is told is kept.
  const test::Outcome outcome =
      run("python3 -c \"import os,pty,select,tty\nm,s=pty.openpty()\ntty.setraw(s)\nos.symlink(os.ttyname(s),'radio')\n"
          "told=open('told','wb',0)\nwhile select.select([m],[],[],4)[0]: told.write(os.read(m,4096))\" & radio=$!\n"
          "for i in $(seq 100); do [ -e radio ] && break; sleep 0.05; done\n"
          "vestige stream trace.mcap --port radio --xbee-api --xbee-address 0013A20041AABBCC --json stream.json\n"
          "code=$?; wait $radio; exit $code");
  EXPECT_EQ(outcome.exit_code, 3) << outcome.standard_error;  // no board acknowledges
  const std::string told = read_text_file(folder_ / "told");
  std::size_t frames = 0;
  for (std::size_t at = 0; at < told.size();) {
    const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(told.at(at + i)); };
    ASSERT_EQ(byte(0), 0x7E) << at;
    const std::size_t length = 256U * byte(1) + byte(2);
    unsigned sum = 0;
    for (std::size_t i = 3; i <= 3 + length; ++i) sum += byte(i);
    EXPECT_EQ(sum % 256, 0xFFU) << at;
    EXPECT_EQ(byte(3), 0x10);
    EXPECT_EQ(told.substr(at + 5, 8), std::string("\0\x13\xA2\0\x41\xAA\xBB\xCC", 8));
    if (byte(18) == 'S' || byte(18) == 'X') ++frames;  // behind the head of the request, and COBS' first byte
    at += length + 4;
  }
  EXPECT_GT(frames, 2U);
  EXPECT_EQ(frames, json_in("stream.json")["sent"]);
}

TEST_F(StreamCommand, ABoardThatDoesNotAnswerIsSaidAndStreamedToAllTheSame) {
  record("--count 20 --rate 60 --duration 0.5");
  const test::Outcome outcome =
      run("python3 -c \"import os,pty,time,tty\nm,s=pty.openpty()\ntty.setraw(s)\nos.symlink(os.ttyname(s),'vest')\n"
          "time.sleep(20)\" & pty=$!\nfor i in $(seq 100); do [ -e vest ] && break; sleep 0.05; done\n"
          "vestige stream trace.mcap --port vest --json stream.json; code=$?; kill $pty; exit $code");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.standard_error, HasSubstr("no board answers"));
  EXPECT_THAT(outcome.standard_error, HasSubstr("were not acknowledged"));
  EXPECT_EQ(json_in("stream.json")["acknowledged"], 0);
  EXPECT_FALSE(json_in("stream.json")["off_acknowledged"]);
}

TEST_F(StreamCommand, ADetectorThatCannotKeepUpIsSaid) {
  record("--rate 10000 --duration 0.03");
  const test::Outcome outcome =
      run("vestige stream trace.mcap --port file:frames --detector exact --rate 10 --json stream.json");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.standard_error, HasSubstr("'exact' does not keep up with the trace"));
  EXPECT_GT(json_in("stream.json")["most_late_s"].get<double>(), 1);
}

TEST_F(StreamCommand, AMapThatBecomesAPipeIsRefusedAndTheStreamEnds) {
  record("--colliders hug --rate 100 --duration 1");
  ASSERT_EQ(run("vestige map make --layout paper6 -o map.png").exit_code, 0);
  const test::Outcome outcome =
      run("timeout 20 vestige stream trace.mcap --port file:frames --map map.png --loop & stream=$!\n"
          "sleep 3; rm map.png; mkfifo map.png; sleep 3; kill -INT $stream; wait $stream");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.standard_error;
  EXPECT_THAT(outcome.standard_error, HasSubstr("map.png: is no longer a regular file"));
}

TEST_F(StreamCommand, WhatCannotBeStreamedIsRefusedWithItsReason) {
  record("--count 2 --rate 60 --duration 0.2");
  expect_failure("vestige stream trace.mcap --port ./ttyUSB9", 1, {"ttyUSB9", "no such device"});
  expect_failure("vestige stream trace.mcap --port trace.mcap", 1, {"trace.mcap", "not a serial device"});
  expect_failure("vestige stream trace.mcap --port ./x --baud 12345", 2, {"--baud", "57600"});
  for (const char* ttl : {"49", "2560", "abc"})
    expect_failure(fmt::format("vestige stream trace.mcap --port ./ttyUSB9 --ttl {}", ttl), 2,
                   {"--ttl", "whole number from 50 to 2550"});
  expect_failure("vestige stream trace.mcap --port ./ttyUSB9 --ttl 51", 2, {"--ttl", "multiple of 10"});
  expect_failure("vestige stream trace.mcap --port osc://localhost", 2, {"--port", "has no port"});
  expect_failure("vestige stream trace.mcap --port osc://localhost:9000 --baud 9600", 2, {"--baud"});
  expect_failure("vestige stream trace.mcap --port file:x --osc-address /a/{n}", 2, {"--osc-address"});
  expect_failure("vestige stream trace.mcap", 2, {"--port"});
  expect_failure("vestige stream nothing.mcap --port file:x", 1, {"nothing.mcap"});
  expect_failure("vestige stream /dev/zero --port file:x", 1, {"/dev/zero", "is a device"}, "x");
  expect_failure("vestige stream trace.mcap --port file:x --loop=3", 2, {"--loop takes no value"}, "x");
  expect_failure("ulimit -f 16; vestige avatar builtin -q -o x.glb", 1, {"x.glb", "File too large"}, "x.glb");
  expect_failure("vestige stream trace.mcap --port file:trace.mcap", 2, {"trace.mcap"});
  expect_failure("vestige stream trace.mcap --port file:x --rate nan", 2, {"--rate"});
  expect_failure("vestige stream trace.mcap --port file:x --map builtin --surface mapped", 2, {"--map", "--surface"});
  EXPECT_FALSE(std::filesystem::exists(folder_ / "x"));
  ASSERT_EQ(run("vestige record -q -o bare.mcap --map none --count 2 --rate 60 --duration 0.2").exit_code, 0);
  expect_failure("vestige stream bare.mcap --port file:x", 1, {"bare.mcap: has no actuator", "--map"});
  EXPECT_EQ(run("vestige stream bare.mcap --port file:x --map builtin").exit_code, 0);
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

TEST_F(StreamCommand, VestCheckOfADeadLineFails) {
  const test::Outcome outcome =
      run("python3 -c \"import os,pty,time,tty\nm,s=pty.openpty()\ntty.setraw(s)\nos.symlink(os.ttyname(s),'vest')\n"
          "time.sleep(20)\" & pty=$!\nfor i in $(seq 100); do [ -e vest ] && break; sleep 0.05; done\n"
          "vestige vest check --port vest --seconds 0.05; code=$?; kill $pty; exit $code");
  EXPECT_EQ(outcome.exit_code, 4);
  EXPECT_THAT(outcome.standard_output, HasSubstr("DOES NOT HEAR"));
}

}  // namespace
}  // namespace vestige
