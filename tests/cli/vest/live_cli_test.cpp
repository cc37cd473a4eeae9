// Lets a vest feel what comes in live, as a user does: the source is another process, over loopback or a pipe.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <limits>
#include <memory>
#include <random>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/background_process.hpp"
#include "tests/support/command_line.hpp"
#include "tests/support/duty_rows.hpp"
#include "tests/support/osc.hpp"
#include "tests/support/udp.hpp"

namespace vestige {
namespace {

using namespace std::chrono_literals;
using test::BackgroundProcess;
using test::bundle;
using test::collider;
using test::placement;
using test::with_id;
using ::testing::Each;
using ::testing::HasSubstr;

class Live : public test::CommandLineTest {
 protected:
  /// A walk among colliders that stay close to the body.
  void record_walk(const std::string& flags = "--rate 100 --duration 2") const {
    ASSERT_EQ(run("vestige record -q -o walk.mcap --animation walk --colliders hug --count 30 " + flags).exit_code, 0);
  }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string source() const { return fmt::format("vmc://127.0.0.1:{}", port_); }
  std::string told() const {
    return std::filesystem::exists(folder_ / "error") ? read_text_file(folder_ / "error") : std::string();
  }

  /// Begins a session, whose vest is the file `felt`.
  std::unique_ptr<BackgroundProcess> live(const std::vector<std::string>& flags = {}) const {
    std::vector<std::string> command = {
        "vestige",         "live",  "--from",       source(), "--port", "file:" + path("felt"), "--json",
        path("live.json"), "--log", path("log.csv")};
    command.insert(command.end(), flags.begin(), flags.end());
    auto process = std::make_unique<BackgroundProcess>(command, folder_ / "error");
    for (int i = 0; i < 600 && told().find("listening on") == std::string::npos; ++i) std::this_thread::sleep_for(50ms);
    return process;
  }

  /// Ends a session as Ctrl-C does. Returns its exit code.
  static int end(BackgroundProcess& session) {
    std::this_thread::sleep_for(300ms);  // until it has taken all
    session.signal(SIGINT);
    return session.wait();
  }

  std::vector<test::Row> log() const { return test::read_log(folder_ / "log.csv"); }
  static bool is_on(const test::Row& row) {
    return std::ranges::any_of(row.level, [](int level) { return level > 0; });
  }

  const std::uint16_t port_ = test::free_udp_port();
};

TEST_F(Live, WhatIsFeltIsRecordedAndReplaysToTheSameContacts) {
  record_walk();
  const auto session = live({"--record", path("felt.mcap")});
  ASSERT_EQ(run("vestige stream walk.mcap --port " + source()).exit_code, 0);
  EXPECT_EQ(end(*session), 0) << told();
  const auto json = json_in("live.json");
  EXPECT_GT(json["contacts"], 20);
  EXPECT_EQ(json["method"], "ccd");
  EXPECT_EQ(json["colliders"], 30);
  EXPECT_EQ(json["recording"]["complete"], true);
  EXPECT_EQ(json["recording"]["frames"], json["frames"]);
  // 200 frames, and the removals at the end.
  EXPECT_GE(json["frames"].get<int>() + json["frames_superseded"].get<int>(), 200);
  EXPECT_TRUE(std::ranges::any_of(log(), is_on));

  ASSERT_EQ(run("vestige replay felt.mcap --method ccd --json replay.json").exit_code, 0);
  const auto replay = json_in("replay.json");
  EXPECT_EQ(replay["contacts"], json["contacts"]);
  EXPECT_EQ(replay["contacts_hash"], json["contacts_hash"]);
  EXPECT_EQ(replay["avatars"][0]["contacts_hash"], json["avatars"][0]["contacts_hash"]);
  // And not by chance.
  ASSERT_EQ(run("vestige replay felt.mcap --method static --json static.json").exit_code, 0);
  EXPECT_NE(json_in("static.json")["contacts_hash"], json["contacts_hash"]);
}

TEST_F(Live, LatencyIsToldAtEveryStage) {
  record_walk();
  const auto session = live();
  ASSERT_EQ(run("vestige stream walk.mcap --port " + source()).exit_code, 0);
  EXPECT_EQ(end(*session), 0) << told();
  const auto json = json_in("live.json");
  const auto& latency = json["latency"];
  for (const char* stage : {"arrival_to_decoded", "arrival_to_detected", "frame_interval", "pose_delay"}) {
    const auto& of = latency[stage];
    EXPECT_LE(of["p50_ms"], of["p99_ms"]) << stage;
    EXPECT_LE(of["p99_ms"], of["max_ms"]) << stage;
    std::uint64_t counted = 0;
    for (const auto& count : of["counts"]) counted += count.get<std::uint64_t>();
    EXPECT_EQ(counted, of["count"]) << stage;
    EXPECT_EQ(of["up_to_ms"].size(), of["counts"].size()) << stage;
  }
  EXPECT_EQ(latency["arrival_to_detected"]["count"], json["frames"]);
  EXPECT_EQ(latency["arrival_to_written"]["count"], json["changes"]);
  EXPECT_GE(latency["arrival_to_detected"]["p50_ms"], latency["arrival_to_decoded"]["p50_ms"]);
  EXPECT_EQ(latency["pose_delay"]["max_ms"], 0) << "each frame has its pose, the first one, too";
}

TEST_F(Live, WhatWasNeverMeasuredIsNotToldAsZero) {
  const test::Outcome outcome = run("echo '{}' | vestige live --from - --port file:felt --json live.json");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.standard_error;
  EXPECT_THAT(outcome.standard_output, ::testing::Not(HasSubstr("time between frames")));
  const auto json = json_in("live.json");
  EXPECT_EQ(json["frames"], 1);
  EXPECT_EQ(json["latency"]["arrival_to_decoded"]["count"], 1);
  EXPECT_TRUE(json["latency"]["arrival_to_decoded"]["p50_ms"].is_number());
  for (const char* stage : {"frame_interval", "arrival_to_acknowledged"}) {
    const auto& of = json["latency"][stage];
    EXPECT_EQ(of["count"], 0) << stage;
    for (const char* key : {"p50_ms", "p95_ms", "p99_ms", "max_ms"}) EXPECT_TRUE(of.at(key).is_null()) << stage << key;
  }
  for (const char* key : {"p50", "p95", "p99", "max"})
    EXPECT_TRUE(json["latency_us"]["acknowledged"].at(key).is_null()) << key;
}

TEST_F(Live, ASourceThatIsKilledLeavesNothingOn) {
  record_walk();
  const auto session = live({"--hold", "10000"});
  {
    BackgroundProcess source_process({"vestige", "stream", path("walk.mcap"), "--loop", "--port", source()},
                                     folder_ / "source_error");
    std::this_thread::sleep_for(3s);
    source_process.signal(SIGKILL);
    source_process.wait();
  }
  for (int i = 0; i < 200 && told().find("no whole frame came for 200 ms") == std::string::npos; ++i)
    std::this_thread::sleep_for(50ms);
  EXPECT_THAT(told(), HasSubstr("no whole frame came for 200 ms: all actuators are off until one comes"));
  EXPECT_EQ(end(*session), 0) << told();
  const auto rows = log();
  ASSERT_GE(rows.size(), 2U);
  EXPECT_TRUE(is_on(rows[rows.size() - 2])) << "whatever the hold";
  EXPECT_THAT(rows.back().level, Each(0));
  EXPECT_GE(json_in("live.json")["silences"], 1);
}

TEST_F(Live, AfterSilenceNothingMovesInTheFirstFrame) {
  const auto session = live({"--record", path("felt.mcap")});
  const test::UdpSender sender(port_);
  for (const float z : {1.0F, 0.9F}) {
    sender.send(collider(5, 0, 1.2F, z));
    std::this_thread::sleep_for(20ms);
  }
  for (int i = 0; i < 200 && told().find("no whole frame") == std::string::npos; ++i) std::this_thread::sleep_for(50ms);
  sender.send(collider(5, 0, 1.2F, -1));  // through the body
  EXPECT_EQ(end(*session), 0) << told();
  const auto json = json_in("live.json");
  EXPECT_EQ(json["frames"].get<int>() + json["frames_superseded"].get<int>(), 3);
  EXPECT_EQ(json["contacts"], 0);
  EXPECT_THAT(told(), HasSubstr("input comes again"));
  ASSERT_EQ(run("vestige replay felt.mcap --method ccd --json replay.json").exit_code, 0);
  EXPECT_EQ(json_in("replay.json")["contacts"], 0);
}

TEST_F(Live, AFloodIsTakenWithoutAQueueAndEveryDatagramIsAccountedFor) {
  constexpr int kDatagrams = 20'000;
  const auto session = live({"--record", path("felt.mcap")});
  const test::UdpSender sender(port_);
  for (int i = 0; i < kDatagrams; ++i) {
    sender.send(collider(i % 50, 0, 1.2F, 0.5F + static_cast<float>(i % 7) * 0.1F));
    if (i % 100 == 0) std::this_thread::sleep_for(2ms);
  }
  std::this_thread::sleep_for(500ms);
  sender.send(collider(99, 0, 1, 1));  // by which the system tells what it discarded
  const int code = end(*session);
  const auto json = json_in("live.json");
  const auto& lost = json["lost"];
  EXPECT_EQ(code, lost["overflowed"] == 0 ? 0 : 3) << told();
  EXPECT_EQ(json["frames"].get<int>() + json["frames_superseded"].get<int>() + lost["overflowed"].get<int>(),
            kDatagrams + 1);
  EXPECT_GT(json["frames"], 10);
  EXPECT_EQ(lost["malformed"], 0);
  // The recording has them, and has lost nothing by that.
  std::istringstream events(run("vestige cat felt.mcap --topic /events").standard_output);
  int superseded = 0;
  for (std::string line; std::getline(events, line);)
    if (const auto event = nlohmann::json::parse(line)["data"]; event["kind"] == "superseded")
      superseded += event["count"].get<int>();
  EXPECT_EQ(superseded, json["frames_superseded"]);
  EXPECT_EQ(run("vestige inspect felt.mcap --json inspect.json").exit_code, 0);
  EXPECT_EQ(json_in("inspect.json")["dropped"], lost["overflowed"]);
}

TEST_F(Live, WhatIsNoPoseMovesNothingAndIsSaid) {
  const auto session = live();
  const test::UdpSender sender(port_);
  const test::UdpSender other(port_);
  const auto root_at = [](double x) { return placement("/VMC/Ext/Root/Pos", "root", {x, 0, 0}, {1, 0, 0, 0}); };
  sender.send(bundle({root_at(0), collider(1, 0, 1.2F, 1), with_id("/VMC/Ext/OK", 1)}));
  std::this_thread::sleep_for(50ms);
  other.send(bundle({root_at(0.5), with_id("/VMC/Ext/OK", 1)}));
  sender.send(bundle({root_at(std::numeric_limits<double>::quiet_NaN()), collider(1, 0, 1.2F, -1)}));
  sender.send(bundle({placement("/VMC/Ext/Bone/Pos", "Hips", {0, 0, 0}, {0, 0, 0, 0}), collider(1, 0, 1.2F, -1)}));
  sender.send(with_id("/somebody/else", 4));
  EXPECT_EQ(end(*session), 3);
  const auto json = json_in("live.json");
  EXPECT_EQ(json["frames"], 1);
  EXPECT_EQ(json["lost"]["malformed"], 2);
  EXPECT_EQ(json["lost"]["strangers"], 1);
  EXPECT_EQ(json["complete"], false);
  EXPECT_THAT(told(), HasSubstr("argument 2 is not finite"));
  EXPECT_THAT(told(), HasSubstr("a second program, 127.0.0.1:"));
  EXPECT_FALSE(std::ranges::any_of(log(), is_on));
}

/// Bytes that no receiver should believe, and a strike by somebody who is not heard.
std::vector<std::byte> hostile(std::mt19937& random) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  std::vector<std::byte> bytes = bundle({collider(1, 0, 1.2F, -1), with_id("/VMC/Ext/OK", 1)});
  switch (random() % 4) {
    case 0:
      break;
    case 1:
      bytes.resize(1 + random() % (bytes.size() - 1));
      break;
    case 2:
      bytes = bundle({collider(1, 0, random() % 2 == 0 ? kNaN : 1e30F, -1), with_id("/VMC/Ext/OK", 1)});
      break;
    default:
      for (std::byte& byte : bytes) byte = static_cast<std::byte>(random());
  }
  return bytes;
}

TEST_F(Live, HostileDatagramsMoveNoMotor) {
  const int count = std::getenv("VESTIGE_LONG") != nullptr ? 1'000'000 : 20'000;
  const auto session = live({"--ttl", "2550"});
  const test::UdpSender sender(port_);
  const test::UdpSender other(port_);
  std::mt19937 random(1);
  const auto there = [](float z) { return bundle({collider(1, 0, 1.2F, z), with_id("/VMC/Ext/OK", 1)}); };
  for (int i = 0; i < count; ++i) {
    if (i % 100 == 0) {
      sender.send(there(1));
      std::this_thread::sleep_for(1ms);
    }
    other.send(hostile(random));
  }
  std::this_thread::sleep_for(500ms);
  sender.send(there(1));
  std::this_thread::sleep_for(500ms);
  sender.send(there(-1));  // through the body
  EXPECT_EQ(end(*session), 3);
  const auto json = json_in("live.json");
  EXPECT_EQ(json["contacts"], 1) << "the valid one";
  const auto& lost = json["lost"];
  const int left_out = lost["malformed"].get<int>() + lost["strangers"].get<int>() + lost["overflowed"].get<int>();
  EXPECT_GT(left_out, count * 9 / 10) << "most of them are whole enough to be counted";
}

TEST_F(Live, MarkersAreRecordedAndEndNothing) {
  for (const bool records : {false, true}) {
    const auto session =
        live(records ? std::vector<std::string>{"--record", path("felt.mcap"), "--force"} : std::vector<std::string>{});
    const test::UdpSender sender(port_);
    for (int i = 0; i < 1500; ++i) {
      sender.send(bundle({collider(1, 0, 1.2F, 1), test::marker("here")}));
      if (i % 100 == 0) std::this_thread::sleep_for(10ms);
    }
    std::this_thread::sleep_for(100ms);
    sender.send(test::marker("last"));
    EXPECT_EQ(end(*session), 0) << told();
    std::filesystem::remove(folder_ / "live.json");
    std::filesystem::remove(folder_ / "log.csv");
  }
  EXPECT_THAT(run("vestige cat felt.mcap --topic /events").standard_output,
              ::testing::AllOf(HasSubstr("\"text\":\"here\""), HasSubstr("\"text\":\"last\"")));
}

TEST_F(Live, LinesOnStandardInputAreFelt) {
  record_walk("--rate 50 --duration 1.5");
  ASSERT_EQ(run("vestige export -q walk.mcap -o walk.ndjson").exit_code, 0);
  const test::Outcome outcome =
      run("while read -r line; do echo \"$line\"; sleep 0.01; done <walk.ndjson | "
          "vestige live --from - --port file:felt --record felt.mcap --json live.json");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.standard_error;
  EXPECT_THAT(outcome.standard_output, HasSubstr("arrival to contacts found:"));
  const auto json = json_in("live.json");
  EXPECT_EQ(json["frames"].get<int>() + json["frames_superseded"].get<int>(), 75);
  EXPECT_GT(json["contacts"], 0);
  ASSERT_EQ(run("vestige replay felt.mcap --method ccd --json replay.json").exit_code, 0);
  EXPECT_EQ(json_in("replay.json")["contacts_hash"], json["contacts_hash"]);
}

TEST_F(Live, AFullDiskEndsTheRecordingAndNotWhatIsFelt) {
  record_walk("--rate 100 --duration 4");
  const test::Outcome outcome =
      run(fmt::format("(trap '' XFSZ; ulimit -f 800; exec vestige live --from {0} --port file:felt --record full.mcap "
                      "--json live.json 2>error) & live=$!\n"
                      "for i in $(seq 600); do grep -q listening error && break; sleep 0.05; done\n"
                      "vestige stream -q walk.mcap --port {0}; sleep 0.5\n"
                      "kill -INT $live; wait $live; code=$?; cat error >&2; exit $code",
                      source()));
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.standard_error, HasSubstr("full.mcap"));
  EXPECT_THAT(outcome.standard_error, HasSubstr("The recording has ended; what is felt goes on."));
  const auto json = json_in("live.json");
  EXPECT_EQ(json["recording"]["complete"], false);
  EXPECT_GE(json["frames"].get<int>() + json["frames_superseded"].get<int>(), 400);
  EXPECT_EQ(json["off_sent"], true);
}

TEST_F(Live, ARecordingEndsAtItsLargestSize) {
  record_walk("--rate 100 --duration 4");
  const auto session = live({"--record", path("felt.mcap"), "--max-size", "450kB"});
  ASSERT_EQ(run("vestige stream -q walk.mcap --port " + source()).exit_code, 0);
  EXPECT_EQ(end(*session), 3);
  EXPECT_THAT(told(), HasSubstr("the recording has ended, by --max-size; what is felt goes on"));
  EXPECT_EQ(run("vestige inspect felt.mcap").exit_code, 0);
  EXPECT_LE(std::filesystem::file_size(folder_ / "felt.mcap"), 450'000U);
}

TEST_F(Live, TwoPeopleFeelOneScene) {
  ASSERT_EQ(
      run("vestige record -q -o pair.mcap --avatar builtin --name ann --animation walk --colliders hug --count 20 "
          "--avatar builtin --name bob --animation walk --at 0,0,2,180 --rate 100 --duration 2")
          .exit_code,
      0);
  std::uint16_t bob_port = test::free_udp_port();
  while (bob_port == port_) bob_port = test::free_udp_port();
  const std::string bob = fmt::format("2=vmc://127.0.0.1:{}", bob_port);
  BackgroundProcess session(
      {"vestige", "live", "--from", "1=" + source(), "--from", bob, "--port", "1=file:" + path("ann"), "--port",
       "2=file:" + path("bob"), "--record", path("felt.mcap"), "--json", path("live.json")},
      folder_ / "error");
  for (int i = 0; i < 600 && told().find("listening on") == std::string::npos; ++i) std::this_thread::sleep_for(50ms);
  ASSERT_EQ(run("vestige stream pair.mcap --port 1=" + source() + " --port " + bob).exit_code, 0);
  EXPECT_EQ(end(session), 0) << told();
  const auto json = json_in("live.json");
  EXPECT_GT(json["avatars"][0]["contacts"], 0);
  EXPECT_GT(json["avatars"][1]["contacts"], 0);
  ASSERT_EQ(run("vestige replay felt.mcap --method ccd --json replay.json").exit_code, 0);
  const auto replay = json_in("replay.json");
  EXPECT_EQ(replay["contacts_hash"], json["contacts_hash"]);
  for (const std::size_t i : {0U, 1U}) EXPECT_EQ(replay["avatars"][i]["contacts"], json["avatars"][i]["contacts"]);
}

TEST_F(Live, RealTimeIsTakenOrSaid) {
  const auto session = live({"--realtime"});
  const test::UdpSender sender(port_);
  sender.send(collider(5, 0, 1.2F, 1));
  EXPECT_EQ(end(*session), 0) << told();
  const auto real_time = json_in("live.json")["real_time"];
  const bool all =
      !real_time["priority"].is_null() && real_time["memory_locked"] == true && !real_time["core"].is_null();
  EXPECT_EQ(real_time["refused"].empty(), all);
  EXPECT_EQ(told().find("rtprio") != std::string::npos, real_time["priority"].is_null());
  EXPECT_EQ(told().find("memlock") != std::string::npos, real_time["memory_locked"] == false);
}

TEST_F(Live, CtrlCEndsASessionAtAnyMoment) {
  record_walk();
  const BackgroundProcess source_process({"vestige", "stream", path("walk.mcap"), "--loop", "--port", source()},
                                         folder_ / "source_error");
  for (int i = 0; i < 12; ++i) {
    BackgroundProcess session({"vestige", "live", "--from", source(), "--port", "file:" + path("felt"), "--record",
                               path("felt.mcap"), "--force", "-q"},
                              folder_ / "error");
    std::this_thread::sleep_for(i * 40ms);
    session.signal(SIGINT);
    // 0: felt; 1: no frame had come; 130: not even begun.
    EXPECT_THAT(session.wait(), ::testing::AnyOf(0, 1, 128 + SIGINT)) << i << "\n" << told();
  }
}

TEST_F(Live, NobodyWhoSendsIsAnError) {
  const auto session = live({"--record", path("felt.mcap")});
  session->signal(SIGINT);
  EXPECT_EQ(session->wait(), 1);
  EXPECT_THAT(told(), HasSubstr("no whole frame arrived, so nothing was felt"));
  for (const char* file : {"felt.mcap", "felt", "log.csv", "live.json"})
    EXPECT_FALSE(std::filesystem::exists(folder_ / file)) << file;
}

TEST_F(Live, AFailureKeepsTheFilesThatForceWouldReplace) {
  for (const char* file : {"felt", "log.csv", "felt.mcap", "live.json"}) write(file, "an earlier one");
  expect_failure(
      "vestige live --from - --port file:felt --log log.csv --record felt.mcap --json live.json --force </dev/null", 1,
      {"no whole frame arrived, so nothing was felt"});
  for (const char* file : {"felt", "log.csv", "felt.mcap", "live.json"})
    EXPECT_EQ(read_text_file(folder_ / file), "an earlier one") << file;
}

TEST_F(Live, FlagsThatSayNothingAreRefused) {
  for (const auto& [flags, cause] :
       {std::pair("--from vmc://localhost --port file:a", "has no port"),
        std::pair("--from nonsense --port file:a", "'nonsense' begins with neither vmc:// nor osc://"),
        std::pair("--from tcp://127.0.0.1:9 --port file:a", "or write -, for lines of JSON on standard input"),
        std::pair("--from 2=vmc://127.0.0.1:9 --port file:a",
                  "person 2 has a source, and there are sources for 1 person"),
        std::pair("--from 1=vmc://127.0.0.1:9 --from 2=osc://127.0.0.1:9 --port 1=file:a",
                  "two people have the source"),
        std::pair("--from 1=- --from 2=vmc://127.0.0.1:9 --port 1=file:a", "lines on standard input are of one person"),
        std::pair("--from - --rate 100 --port file:a", "each line on standard input is a frame"),
        std::pair("--from - --pose latest --port file:a", "each line on standard input is a frame"),
        std::pair("--from - --port vmc://127.0.0.1:9", "is no vest"),
        std::pair("--from - --port file:a --ring 5", "nothing is recorded"),
        std::pair("--from - --port file:a --record -", "not recorded to standard output"),
        std::pair("--from - --port file:a --avatar 2=builtin", "there is no person 2"),
        std::pair("--from - --port file:a --map none", "no actuator to switch")})
    expect_failure(std::string("vestige live ") + flags, 2, {cause}, "a");
  expect_failure("vestige live --from vmc://192.0.2.1:9 --port file:a", 1, {"vmc://192.0.2.1:9", "could not listen"},
                 "a");
}

}  // namespace
}  // namespace vestige
