// Plays people to a live recording as a user does, in another process over loopback.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <memory>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/background_process.hpp"
#include "tests/support/builtin_avatar.hpp"
#include "tests/support/command_line.hpp"
#include "tests/support/made/edited_glb.hpp"
#include "tests/support/udp.hpp"
#include "traces/trace_file/trace_reader.hpp"

namespace vestige {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

class StreamPeople : public test::CommandLineTest {
 protected:
  /// Frames that are so far apart that a busy machine records each of them.
  static constexpr const char* kSlow = " --rate 1.7 --duration 3 ";

  void record(const std::string& flags) const {
    const test::Outcome outcome = run("vestige record -q -o sent.mcap " + flags);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.standard_error;
  }

  /// Begins to record what comes to these ports, each that of a person with the built-in avatar.
  std::unique_ptr<test::BackgroundProcess> record_live(const std::vector<std::uint16_t>& ports) const {
    std::vector<std::string> command = {"vestige", "record", "-o", (folder_ / "heard.mcap").string()};
    for (const std::uint16_t port : ports)
      command.insert(command.end(), {"--avatar", "builtin", "--live", fmt::format("vmc://127.0.0.1:{}", port)});
    auto recorder = std::make_unique<test::BackgroundProcess>(command, folder_ / "error");
    const auto is_listening = [this] {
      return std::filesystem::exists(folder_ / "error") &&
             read_text_file(folder_ / "error").find("listening on") != std::string::npos;
    };
    for (int i = 0; i < 600 && !is_listening(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(50));
    return recorder;
  }

  /// Ends a recording. Returns its frames.
  std::vector<TraceFrame> heard(test::BackgroundProcess& recorder) const {
    std::this_thread::sleep_for(std::chrono::milliseconds(500));  // until the recorder has taken all
    recorder.signal(SIGINT);
    recorder.wait();  // 3 if the machine was so busy that a frame was lost
    EXPECT_THAT(read_text_file(folder_ / "error"), Not(HasSubstr("several sources")));
    return frames_of("heard.mcap");
  }

  std::vector<TraceFrame> frames_of(const std::string& name) const {
    TraceReader reader(folder_ / name, People::kSeveral);
    std::vector<TraceFrame> frames;
    for (TraceFrame frame; reader.next(frame);) frames.push_back(frame);
    return frames;
  }

  /// Whether two poses put every joint in the same place, with the same rotation, to single precision.
  static bool is_same(const Pose& a, const Pose& b) {
    constexpr double kSinglePrecision = 1e-5;
    const Avatar& avatar = test::builtin_avatar();
    std::vector<glm::dmat4> world_a;
    std::vector<glm::dmat4> world_b;
    world_matrices(avatar, a, world_a);
    world_matrices(avatar, b, world_b);
    for (const PaletteEntry& joint : avatar.palette) {
      const auto node = static_cast<std::size_t>(joint.node);
      glm::dmat4 difference = world_a[node] - world_b[node];
      difference[3] += glm::dvec4(a.origin_m - b.origin_m, 0);
      for (int column = 0; column < 4; ++column)
        if (!(glm::length(difference[column]) < kSinglePrecision)) return false;
    }
    return true;
  }

  /// Whether two frames have the same poses to single precision, and the same colliders to the bit.
  static bool is_same(const TraceFrame& a, const TraceFrame& b) {
    if (a.poses.size() != b.poses.size()) return false;
    for (std::size_t i = 0; i < a.poses.size(); ++i)
      if (!is_same(a.poses[i], b.poses[i])) return false;
    return std::ranges::is_permutation(a.colliders, b.colliders, [](const auto& c, const auto& d) {
      return c.id == d.id && c.position_m == d.position_m && c.radius_m == d.radius_m && c.owner == d.owner;
    });
  }

  /// Expects that each frame of `sent` is among `heard`, in order, and that the last of `heard` has no collider.
  static void expect_all(const std::vector<TraceFrame>& sent, const std::vector<TraceFrame>& heard) {
    ASSERT_FALSE(sent.empty());
    auto at = heard.begin();
    for (const TraceFrame& frame : sent) {
      at = std::find_if(at, heard.end(), [&](const TraceFrame& other) { return is_same(frame, other); });
      ASSERT_NE(at, heard.end()) << "frame " << frame.index << " was not recorded";
    }
    EXPECT_THAT(heard.back().colliders, IsEmpty()) << "nobody moves them any more";
  }

  const std::uint16_t port_ = test::free_udp_port();
  const std::string flag_ = fmt::format(" --port vmc://127.0.0.1:{} ", port_);
};

TEST_F(StreamPeople, ARecordingOfWhatIsStreamedHasTheTracesPosesAndColliders) {
  record("--animation walk --colliders hug --count 30 --radius 0.02 --at 1,0,-2,30" + std::string(kSlow));
  const auto recorder = record_live({port_});
  const test::Outcome outcome = run("vestige stream sent.mcap --json stream.json" + flag_);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.standard_error;
  EXPECT_EQ(outcome.standard_error, "");
  const std::vector<TraceFrame> sent = frames_of("sent.mcap");
  expect_all(sent, heard(*recorder));
  EXPECT_FALSE(is_same(sent.front().poses[0], sent[1].poses[0])) << "somebody who stands still tests nothing";
  const auto json = json_in("stream.json");
  EXPECT_EQ(json["frames"], sent.size());
  EXPECT_EQ(json["sent"], sent.size());
  EXPECT_EQ(json["complete"], true);
  EXPECT_EQ(json["colliders_left_out"], 0);
  EXPECT_LT(json["deviation_m"].get<double>(), 1e-5);
  EXPECT_EQ(json["avatars"][0]["link"], json["link"]);
  EXPECT_FALSE(json.contains("contacts")) << "nothing is detected";
  EXPECT_THAT(outcome.standard_output, HasSubstr(fmt::format("sent {} frames", sent.size())));
}

TEST_F(StreamPeople, SeveralPeopleComeBackAsOneTraceWithEachColliderOnce) {
  record(
      "--avatar builtin --name ann --animation walk --colliders hug --count 20 --avatar builtin --name bob "
      "--animation walk --at 0,0,2,180" +
      std::string(kSlow));
  std::uint16_t bob_port = test::free_udp_port();
  while (bob_port == port_) bob_port = test::free_udp_port();
  const auto recorder = record_live({port_, bob_port});
  const test::Outcome outcome =
      run(fmt::format("vestige stream sent.mcap --json stream.json --port 2=vmc://127.0.0.1:{} "
                      "--port 1=vmc://127.0.0.1:{}",
                      bob_port, port_));
  EXPECT_EQ(outcome.exit_code, 0) << outcome.standard_error;
  const std::vector<TraceFrame> sent = frames_of("sent.mcap");
  expect_all(sent, heard(*recorder));
  const auto json = json_in("stream.json");
  EXPECT_EQ(json["sent"], 2 * sent.size());
  EXPECT_EQ(json["avatars"][1]["name"], "bob");
  EXPECT_EQ(json["avatars"][1]["link"]["port"], fmt::format("vmc://127.0.0.1:{}", bob_port));
}

TEST_F(StreamPeople, NoWayLeadsFromTheEndToTheBeginningOfALoop) {
  record("--animation walk --count 3 --rate 1.7 --duration 1.8");
  const auto recorder = record_live({port_});
  const test::Outcome outcome = run("vestige stream sent.mcap --loop --json stream.json" + flag_ +
                                    "& stream=$!\nsleep 6\nkill -INT $stream; wait $stream");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.standard_error;
  EXPECT_GE(json_in("stream.json")["loops"], 1);
  const std::vector<TraceFrame> sent = frames_of("sent.mcap");
  const std::vector<TraceFrame> all = heard(*recorder);
  expect_all(sent, all);
  std::size_t jumps = 0;
  for (const TraceFrame& frame : all) {
    if (frame.teleported.empty()) continue;
    ++jumps;
    EXPECT_EQ(std::set(frame.teleported.begin(), frame.teleported.end()), std::set({0U, 1U, 2U}));
    EXPECT_TRUE(std::ranges::is_permutation(frame.colliders, sent.front().colliders, {}, &ColliderSample::position_m,
                                            &ColliderSample::position_m));
  }
  EXPECT_GE(jumps, 1U);
}

TEST_F(StreamPeople, CtrlCTakesTheCollidersAwayAndIsSaid) {
  record("--count 3 --rate 50 --duration 60");
  const auto recorder = record_live({port_});
  const test::Outcome outcome = run("vestige stream sent.mcap --json stream.json" + flag_ +
                                    "& stream=$!\nsleep 3\nkill -INT $stream; wait $stream");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.standard_error, HasSubstr("stopped after"));
  EXPECT_EQ(json_in("stream.json")["complete"], false);
  const std::vector<TraceFrame> all = heard(*recorder);
  ASSERT_FALSE(all.empty());
  EXPECT_TRUE(std::ranges::any_of(all, [](const TraceFrame& frame) { return frame.colliders.size() == 3; }));
  EXPECT_THAT(all.back().colliders, IsEmpty());
}

TEST_F(StreamPeople, NobodyWhoListensIsSaidAndStreamedToAllTheSame) {
  record("--count 3 --rate 50 --duration 0.5");
  const test::Outcome outcome = run("vestige stream sent.mcap --json stream.json" + flag_);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.standard_error;
  EXPECT_THAT(outcome.standard_error, HasSubstr("no program listens there now; frames are sent anyway"));
  EXPECT_EQ(json_in("stream.json")["sent"], 25);
}

TEST_F(StreamPeople, WhatVmcCannotSayIsToldWithItsSize) {
  record("--count 2 --rate 50 --duration 0.2");
  ASSERT_EQ(run("vestige export -q sent.mcap -o csv").exit_code, 0);
  // Every head twice as large.
  ASSERT_EQ(run("python3 -c \"import csv\nrows=list(csv.reader(open('csv/poses.csv')))\n"
                "at=[i for i,n in enumerate(rows[0]) if n.lower()=='head.sx'][0]\n"
                "for r in rows[1:]: r[at:at+3]=['2']*3\ncsv.writer(open('csv/poses.csv','w')).writerows(rows)\" && "
                "vestige import -q csv -o large.mcap")
                .exit_code,
            0);
  const test::Outcome outcome = run("vestige stream large.mcap --json stream.json" + flag_);
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.standard_error, HasSubstr("large.mcap: VMC cannot say the whole pose: in frame 0, the skin"));
  EXPECT_THAT(outcome.standard_output, HasSubstr("mm from the trace's, at joint"));
  EXPECT_GT(json_in("stream.json")["deviation_m"].get<double>(), 0.05);
}

TEST_F(StreamPeople, LimbsAreLeftOutAndTold) {
  record("--avatar builtin --limbs hand_left --rate 50 --duration 0.2");
  const test::Outcome outcome = run("vestige stream sent.mcap --json stream.json" + flag_);
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.standard_error, HasSubstr("limbs of people are not sent"));
  EXPECT_GT(json_in("stream.json")["colliders_left_out"], 0);
}

TEST_F(StreamPeople, AnAvatarWithoutABodyIsRefused) {
  write("thing.glb", test::edited_glb(builtin_avatar_glb(), [](nlohmann::json& json) {
          for (std::size_t i = 0; i < json["nodes"].size(); ++i) json["nodes"][i]["name"] = fmt::format("part {}", i);
        }));
  record("--avatar thing.glb --map none --count 2 --rate 50 --duration 0.2");
  expect_failure("vestige stream sent.mcap" + flag_, 1,
                 {"sent.mcap: no joint is recognised as a bone of a human body", "use a VRM file"});
}

TEST_F(StreamPeople, FlagsOfVestsAreRefused) {
  record("--count 2 --rate 50 --duration 0.2");
  for (const char* flags : {"--map builtin", "--law speed", "--hold 5", "--detector cpu", "--log x.csv", "--ttl 100",
                            "--baud 9600", "--osc-address /a/{n}", "--levels pressure", "--skip off"}) {
    const std::string flag = std::string(flags).substr(0, std::string(flags).find(' '));
    expect_failure("vestige stream sent.mcap" + flag_ + flags, 2,
                   {flag + ": does not apply to 'vmc://", "leave it out"}, "x.csv");
  }
  expect_failure("vestige stream sent.mcap --port 1=vmc://127.0.0.1:9 --port 2=osc://127.0.0.1:9", 2,
                 {"--port", "'osc://127.0.0.1:9' drives a vest"});
  expect_failure("vestige stream sent.mcap --port 1=vmc://127.0.0.1:9 --port 2=vmc://127.0.0.1:9", 2,
                 {"would be the port of two people"});
  expect_failure("vestige stream sent.mcap --port 2=VMC://127.0.0.1:9", 2, {"there is no person 2"});
  expect_failure("vestige stream sent.mcap --port vmc://localhost", 2, {"--port", "has no port"});
  expect_failure("vestige stream sent.mcap --port vmc://no.such.host.invalid:9", 1, {"vmc://no.such.host.invalid:9"});
  expect_failure("vestige vest check --port vmc://127.0.0.1:9", 2, {"--port", "is no vest"});
}

}  // namespace
}  // namespace vestige
