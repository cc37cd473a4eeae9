// Streams traces as a user does, to whatever is no board: files, pipes, OSC, radios, and lines that nobody answers.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/command_line.hpp"
#include "tests/support/duty_rows.hpp"

namespace vestige {
namespace {

using test::Levels;
using test::read_log;
using test::Row;
using ::testing::HasSubstr;
using ::testing::Not;

class StreamToOtherSinks : public test::CommandLineTest {
 protected:
  void record(const std::string& flags) const {
    ASSERT_EQ(run("vestige record -q -o trace.mcap " + flags).exit_code, 0);
  }

  /// Runs `command` beside a serial line called 'vest' that nobody answers.
  test::Outcome run_beside_dead_line(const std::string& command) const {
    return run(
        "python3 -c \"import os,pty,time,tty\nm,s=pty.openpty()\ntty.setraw(s)\nos.symlink(os.ttyname(s),'vest')\n"
        "time.sleep(60)\" & pty=$!\nfor i in $(seq 100); do [ -e vest ] && break; sleep 0.05; done\n" +
        command + "; code=$?; kill $pty; exit $code");
  }
};

TEST_F(StreamToOtherSinks, PortsBelongToPeopleWhoAreThere) {
  record(
      "--avatar builtin --name ann --colliders hug --rate 100 --duration 0.2 --avatar builtin --name bob --at 0,0,3");
  for (const auto& [flags, cause] :
       {std::pair("--port file:a", "trace.mcap holds 2 people"),
        std::pair("--port 3=file:a", "there is no person 3 in trace.mcap, which holds 2 people"),
        std::pair("--port 0=file:a", "people count from 1"), std::pair("--port 1=", "names no port"),
        std::pair("--port 1=file:a --port 1=file:b", "person 1 gets two ports"),
        std::pair("--port 1=file:a --port 2=file:a", "'file:a' would be the vest of two people"),
        std::pair("--port 1=file:a --map 2=builtin", "person 2 has no --port"),
        std::pair("--port 1=file:a --map 1=builtin --map 1=paper6", "person 1 gets two maps"),
        std::pair("--port 1=file:a --port 2=file:b --log -", "each of 2 vests has a log"),
        std::pair("--port 1=file:a --port 2=file:log.2.csv --log log.csv", "log.2.csv"),
        std::pair("--port 1=osc://127.0.0.1:9 --port 2=OSC://127.0.0.1:10 --baud 9600", "not a serial port"),
        std::pair("--port 1=file:a --port 2=osc://127.0.0.1:9 --xbee-api", "not a serial port")}) {
    const test::Outcome outcome = run(std::string("vestige stream trace.mcap ") + flags);
    EXPECT_EQ(outcome.exit_code, 2) << flags;
    EXPECT_THAT(outcome.standard_error, HasSubstr(cause)) << flags;
    EXPECT_EQ(run("ls a b log.csv log.2.csv 2>/dev/null").standard_output, "") << flags;
  }
  // One of the two may wear no vest.
  ASSERT_EQ(run("vestige stream trace.mcap --port 2=file:b --log log.csv --json stream.json").exit_code, 0);
  EXPECT_TRUE(json_in("stream.json")["avatars"][0]["link"].is_null());
  EXPECT_EQ(json_in("stream.json")["avatars"][1]["link"]["port"], "file:b");
}

TEST_F(StreamToOtherSinks, AMapThatIsEditedWhileItIsFeltIsReadAgainAndABadOneIsNot) {
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
  EXPECT_THAT(outcome.standard_error, HasSubstr("map.png: was changed, and is felt as it is now"));
  EXPECT_THAT(outcome.standard_error, HasSubstr("The previous map stays in use"));
  const std::vector<Row> log = read_log(folder_ / "log.csv");
  ASSERT_FALSE(log.empty());
  EXPECT_TRUE(std::ranges::any_of(log, [](const Row& row) { return row.level == Levels{255, 0}; }));
  EXPECT_EQ(log.back().level[0], 0);
  EXPECT_TRUE(std::ranges::any_of(log, [](const Row& row) { return row.level == Levels{0, 255}; }));
}

TEST_F(StreamToOtherSinks, FramesGoToStandardOutputAsTheyWouldGoDownTheWire) {
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

TEST_F(StreamToOtherSinks, ParametersGoByOscToWhoeverListens) {
  record("--colliders hug --rate 100 --duration 1");
  const test::Outcome outcome =
      run("python3 -c \"import socket\ns=socket.socket(socket.AF_INET,socket.SOCK_DGRAM)\ns.bind(('127.0.0.1',0))\n"
          "open('port.new','w').write(str(s.getsockname()[1]))\nimport os\nos.rename('port.new','port')\n"
          "s.settimeout(60)\nheard=open('heard','wb')\n"
          "try:\n  while True: heard.write(s.recv(65536)); s.settimeout(3)\nexcept TimeoutError: pass\" & listener=$!\n"
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
  // Both ends count the same, and no bundle is empty.
  EXPECT_EQ(heard.size(), json_in("stream.json")["link"]["bytes"]);
  std::size_t bundles = 0;
  for (std::size_t at = heard.find("#bundle"); at != std::string::npos; at = heard.find("#bundle", at + 16)) {
    EXPECT_NE(heard.substr(at + 16, 7), "#bundle");
    ++bundles;
  }
  EXPECT_EQ(bundles, json_in("stream.json")["link"]["datagrams"]);
  // That listener has gone.
  const test::Outcome alone = run("vestige stream trace.mcap --port OSC://127.0.0.1:$(cat port)");
  EXPECT_EQ(alone.exit_code, 0) << alone.standard_error;
  EXPECT_THAT(alone.standard_error, HasSubstr("no program listens there now"));
}

TEST_F(StreamToOtherSinks, AKilledStreamLeavesNothingOnOverOsc) {
  record("--colliders hug --rate 100 --duration 1");
  run("python3 -c \"import socket\ns=socket.socket(socket.AF_INET,socket.SOCK_DGRAM)\ns.bind(('127.0.0.1',0))\n"
      "open('port.new','w').write(str(s.getsockname()[1]))\nimport os\nos.rename('port.new','port')\n"
      "s.settimeout(60)\non=b',f\\0\\0\\x3f\\x80\\0\\0'\nlast=b''\n"
      "while on not in last: last=s.recv(65536)\n"
      "open('on','w').close()\n"
      "try:\n  while True: last=s.recv(65536); s.settimeout(2)\nexcept TimeoutError: open('last','wb').write(last)\" & "
      "listener=$!\nfor i in $(seq 100); do [ -e port ] && break; sleep 0.05; done\n"
      "vestige stream -q trace.mcap --port osc://127.0.0.1:$(cat port) --osc-address '/vest/{n}' --loop --hold 1e6 & "
      "stream=$!\nfor i in $(seq 1000); do [ -e on ] && break; sleep 0.05; done\n"
      "kill -KILL $stream; wait $listener");
  const std::string last = read_text_file(folder_ / "last");
  EXPECT_THAT(last, HasSubstr("/vest/6"));
  EXPECT_THAT(last, Not(HasSubstr(std::string("\x3f\x80\0\0", 4)))) << "an actuator is still on";
}

TEST_F(StreamToOtherSinks, AnXbeeInApiModeGetsItsFrames) {
  record("--colliders hug --rate 100 --duration 0.5");
  // A radio that nobody answers through: what it is told is kept.
  const test::Outcome outcome =
      run("python3 -c \"import os,pty,select,tty\nm,s=pty.openpty()\ntty.setraw(s)\nos.symlink(os.ttyname(s),'radio')\n"
          "told=open('told','wb',0)\nwait=60\nwhile select.select([m],[],[],wait)[0]: told.write(os.read(m,4096)); "
          "wait=4\" & radio=$!\n"
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

TEST_F(StreamToOtherSinks, ABoardThatDoesNotAnswerIsSaidAndStreamedToAllTheSame) {
  record("--count 20 --rate 60 --duration 0.5");
  const test::Outcome outcome = run_beside_dead_line("vestige stream trace.mcap --port vest --json stream.json");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.standard_error, HasSubstr("no board answers"));
  EXPECT_THAT(outcome.standard_error, HasSubstr("were not acknowledged"));
  EXPECT_EQ(json_in("stream.json")["acknowledged"], 0);
  EXPECT_TRUE(json_in("stream.json")["latency_us"]["acknowledged"]["p50"].is_null());
  EXPECT_FALSE(json_in("stream.json")["off_acknowledged"]);
  EXPECT_FALSE(json_in("stream.json")["zeros_acknowledged"]);
  EXPECT_THAT(outcome.standard_error, HasSubstr("nothing confirms that all actuators are off"));
  EXPECT_THAT(outcome.standard_output, HasSubstr("all actuators off at the end: NOT CONFIRMED"));
}

/// A board that knows hello and states, and takes all other frames for noise. It writes its levels to 'levels' whenever
/// they change.
constexpr const char* kForeignBoard = R"(
import os, pty, tty
master, slave = pty.openpty()
tty.setraw(slave)
os.symlink(os.ttyname(slave), 'vest')

def crc(data):
    value = 0xFFFF
    for byte in data:
        value ^= byte << 8
        for _ in range(8):
            value = (value << 1 ^ 0x1021 if value & 0x8000 else value << 1) & 0xFFFF
    return bytes([value & 255, value >> 8])

def decode(data):
    out, at = b'', 0
    while at < len(data):
        code = data[at]
        out += data[at + 1:at + code]
        at += code
        if code < 255 and at < len(data):
            out += b'\0'
    return out

def send(data):
    data += crc(data)
    os.write(master, b''.join(bytes([len(part) + 1]) + part for part in data.split(b'\0')) + b'\0')

line = b''
while True:
    line += os.read(master, 4096)
    *frames, line = line.split(b'\0')
    for frame in map(decode, frames):
        if len(frame) < 4 or crc(frame[:-2]) != frame[-2:]:
            continue
        if frame[:1] == b'H':
            send(b'H' + frame[1:2] + bytes([1, 6, 0]))
        if frame[:1] == b'S':
            open('levels', 'a').write(' '.join(map(str, frame[4:-2])) + '\n')
            send(b'A' + frame[1:2] + bytes([0, 0]))
)";

TEST_F(StreamToOtherSinks, ABoardThatDoesNotKnowOffEndsOffAndWhatItDidNotConfirmIsSaid) {
  record("--colliders hug --rate 100 --duration 0.5");
  std::ofstream(folder_ / "board.py") << kForeignBoard;
  const auto with_board = [&](const std::string& command) {
    return run(
        "rm -f vest levels; python3 board.py & board=$!\n"
        "for i in $(seq 100); do [ -e vest ] && break; sleep 0.05; done\n" +
        command + "; code=$?; kill $board; exit $code");
  };
  const auto expect_off = [&] {
    const std::string levels = read_text_file(folder_ / "levels");
    EXPECT_THAT(levels, HasSubstr("255"));
    EXPECT_TRUE(levels.ends_with("\n0 0 0 0 0 0\n")) << levels;
  };
  const test::Outcome outcome = with_board("vestige stream trace.mcap --port vest --hold 1e6 --json stream.json");
  EXPECT_EQ(outcome.exit_code, 3) << outcome.standard_error;
  EXPECT_THAT(outcome.standard_error, HasSubstr("the board may not know OFF"));
  EXPECT_THAT(outcome.standard_output, HasSubstr("all actuators off at the end: all levels 0 acknowledged, OFF not"));
  EXPECT_TRUE(json_in("stream.json")["off_sent"]);
  EXPECT_FALSE(json_in("stream.json")["off_acknowledged"]);
  EXPECT_TRUE(json_in("stream.json")["zeros_acknowledged"]);
  expect_off();

  const test::Outcome check = with_board("vestige vest check --port vest --seconds 0.1 --json check.json");
  EXPECT_EQ(check.exit_code, 4) << check.standard_error;
  EXPECT_THAT(check.standard_output, HasSubstr("the board may not know OFF"));
  EXPECT_TRUE(json_in("check.json")["zeros_acknowledged"]);
  expect_off();
}

TEST_F(StreamToOtherSinks, ADetectorThatCannotKeepUpIsSaid) {
  record("--rate 10000 --duration 0.03");
  const test::Outcome outcome =
      run("vestige stream trace.mcap --port file:frames --detector exact --rate 10 --json stream.json");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.standard_error, HasSubstr("'exact' does not keep up with the trace"));
  EXPECT_GT(json_in("stream.json")["most_late_s"].get<double>(), 1);
}

TEST_F(StreamToOtherSinks, AMapThatBecomesAPipeIsRefusedAndTheStreamEnds) {
  record("--colliders hug --rate 100 --duration 1");
  ASSERT_EQ(run("vestige map make --layout paper6 -o map.png").exit_code, 0);
  const test::Outcome outcome =
      run("timeout 20 vestige stream trace.mcap --port file:frames --map map.png --loop & stream=$!\n"
          "sleep 3; rm map.png; mkfifo map.png; sleep 3; kill -INT $stream; wait $stream");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.standard_error;
  EXPECT_THAT(outcome.standard_error, HasSubstr("map.png: is no longer a regular file"));
}

TEST_F(StreamToOtherSinks, WhatCannotBeStreamedIsRefusedWithItsReason) {
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

TEST_F(StreamToOtherSinks, VestCheckOfADeadLineFails) {
  const test::Outcome outcome = run_beside_dead_line("vestige vest check --port vest --seconds 0.05");
  EXPECT_EQ(outcome.exit_code, 4);
  EXPECT_THAT(outcome.standard_output, HasSubstr("DOES NOT HEAR"));
}

}  // namespace
}  // namespace vestige
