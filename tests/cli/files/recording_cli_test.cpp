// Recording in the field, as a user does it: limits, parts, the ring, live input.

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <map>
#include <optional>
#include <thread>

#include "tests/support/background_process.hpp"
#include "tests/support/builtin_avatar.hpp"
#include "tests/support/command_line.hpp"
#include "tests/support/osc.hpp"
#include "tests/support/udp.hpp"
#include "tests/traces/gltf/gltf_builder.hpp"
#include "traces/base/error.hpp"
#include "traces/files/input_file.hpp"
#include "traces/trace_file/trace_reader.hpp"

namespace vestige {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class Recording : public test::CommandLineTest {
 protected:
  std::string hash_of(const std::string& trace) const {
    return json_of("vestige replay " + trace + " --detector cpu --json -")["texture_hash"];
  }

  std::vector<TraceFrame> frames_of(const std::string& trace) const {
    TraceReader reader(folder_ / trace);
    std::vector<TraceFrame> frames;
    TraceFrame frame;
    while (reader.next(frame)) frames.push_back(frame);
    return frames;
  }

  /// Those that are there while it is being written, perhaps none.
  std::vector<TraceFrame> frames_so_far(const std::string& trace) const {
    try {
      return frames_of(trace);
    } catch (const Error&) {
      return {};
    }
  }

  /// Its frames as lines of JSON (traces/FORMAT.md).
  std::string lines_of(const std::string& trace) const {
    std::string lines;
    for (const TraceFrame& frame : frames_of(trace)) {
      lines += fmt::format(R"({{"frame":{},"time_s":{}.{:09},"pose":{{"origin":[{},{},{}],"nodes":[)", frame.index,
                           frame.time_ns / 1'000'000'000, frame.time_ns % 1'000'000'000, frame.poses.front().origin_m.x,
                           frame.poses.front().origin_m.y, frame.poses.front().origin_m.z);
      std::vector<std::string> parts;
      for (const NodeLocal& node : frame.poses.front().nodes) {
        const glm::vec3& t = node.translation;
        const glm::quat& r = node.rotation;
        std::vector<std::string> numbers;
        for (const float value : {t.x, t.y, t.z, r.x, r.y, r.z, r.w, node.scale.x, node.scale.y, node.scale.z}) {
          const std::string text = fmt::format("{}", value);
          numbers.push_back(text == "-0" ? "-0.0" : text);  // -0 is a whole number, which has no sign
        }
        parts.push_back(fmt::format("[{}]", fmt::join(numbers, ",")));
      }
      lines += fmt::format("{}]}},\"colliders\":[", fmt::join(parts, ","));
      parts.clear();
      for (const ColliderSample& collider : frame.colliders)
        parts.push_back(fmt::format(R"({{"id":{},"position":[{},{},{}]}})", collider.id, collider.position_m.x,
                                    collider.position_m.y, collider.position_m.z));
      lines += fmt::format("{}]", fmt::join(parts, ","));
      if (!frame.teleported.empty()) lines += fmt::format(",\"teleported\":[{}]", fmt::join(frame.teleported, ","));
      lines += "}\n";
    }
    return lines;
  }
};

/// A triangle whose far corner rests two metres up by a morph target. Animation "turn" turns it, and "breathe" also
/// moves the target by half.
std::string breathing_avatar() {
  test::GltfBuilder builder = test::one_triangle();
  const std::size_t up = builder.add("VEC3", std::vector<float>{0, 0, 0, 0, 0, 0, 0, 2, 0});
  const std::size_t weights = builder.add("SCALAR", std::vector<float>{1, 1.5F});
  test::primitive(builder)["targets"] = {{{"POSITION", up}}};
  builder.document["meshes"][0]["weights"] = {1};
  for (const char* name : {"turn", "breathe"}) {
    test::animate(builder, 0, "rotation", "LINEAR", {0, 1}, {0, 0, 0, 1, 0, 0, 1, 0});
    builder.document["animations"].back()["name"] = name;
  }
  nlohmann::json& breathe = builder.document["animations"][1];
  breathe["samplers"].push_back({{"input", breathe["samplers"][0]["input"]}, {"output", weights}});
  breathe["channels"].push_back({{"sampler", 1}, {"target", {{"node", 0}, {"path", "weights"}}}});
  const std::vector<std::byte> glb = builder.glb();
  return {reinterpret_cast<const char*>(glb.data()), glb.size()};
}

TEST_F(Recording, RefusesAnAnimationOfMorphTargetsUnlessItIsToldToIgnoreThem) {
  write("a.glb", breathing_avatar());
  const std::string record = "vestige record --avatar a.glb --colliders still --count 5 --rate 10 --duration 1 ";
  expect_failure(
      record + "--animation breathe -o b.mcap", 1,
      {"a.glb: animations[1].channels[1]: animation 'breathe' moves the skin by morph targets, by at most 1 m",
       "add --ignore-morphs to leave this motion out, or choose another --animation"},
      "b.mcap");
  for (const char* other : {"--animation turn", "--animation none", ""}) {
    const test::Outcome outcome = run(record + other + " --force -o a.mcap");
    EXPECT_EQ(outcome.exit_code, 0) << other << outcome.standard_error;
    EXPECT_THAT(outcome.standard_error, Not(HasSubstr("morph"))) << other;
  }
  const test::Outcome ignored = run(record + "--animation breathe --ignore-morphs -o b.mcap");
  EXPECT_EQ(ignored.exit_code, 0);
  EXPECT_THAT(ignored.standard_error, HasSubstr("by at most 1 m (all at their most, in the rest pose); this motion is "
                                                "left out\n"));
  EXPECT_EQ(hash_of("b.mcap"), hash_of("a.mcap")) << "both turn";
}

TEST_F(Recording, KeepsTheShapeThatMorphTargetsGiveTheAvatar) {
  write("a.glb", breathing_avatar());
  ASSERT_EQ(run("vestige record --avatar a.glb --colliders still --count 5 --rate 10 --duration 1 -o a.mcap").exit_code,
            0);
  ASSERT_EQ(run("vestige avatar a.glb -o written.glb").exit_code, 0);
  ASSERT_EQ(run("vestige export a.mcap -o exported.glb && vestige export a.mcap -o folder").exit_code, 0);
  EXPECT_GE(json_of("vestige avatar --json - exported.glb")["bounds"]["max"][1], 3) << "the avatar, and colliders";
  for (const char* file : {"a.glb", "written.glb", "folder/avatar.glb"})
    EXPECT_EQ(json_of(std::string("vestige avatar --json - ") + file)["bounds"]["max"],
              nlohmann::json::parse("[1, 3, 0]"))
        << file;
  const auto animations = json_of("vestige avatar a.glb --json -")["animations"];
  EXPECT_EQ(animations[0]["morph_m"], 0);
  EXPECT_EQ(animations[1]["morph_m"], 1);
}

TEST_F(Recording, InPartsMergesToWhatOneFileWouldHaveBeen) {
  const std::string scene = "vestige record --colliders rain --count 40 --rate 200 --duration 2 ";
  ASSERT_EQ(run(scene + "-o whole.mcap").exit_code, 0);
  const auto json = json_of(scene + "-o part.mcap --split 0.5 --json -");
  EXPECT_EQ(json["files"].size(), 4U);
  EXPECT_EQ(json["frames"], 400);
  EXPECT_EQ(run("vestige inspect part-0003.mcap").exit_code, 0);
  ASSERT_EQ(run("vestige merge part-*.mcap -o merged.mcap").exit_code, 0);
  EXPECT_EQ(hash_of("merged.mcap"), hash_of("whole.mcap"));

  ASSERT_EQ(run(scene + "-o sized.mcap --split 400kB").exit_code, 0);
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
    if (entry.path().filename().string().starts_with("sized-")) {
      EXPECT_LE(entry.file_size(), 400'000U);
    }
  }
  ASSERT_EQ(run("vestige merge sized-*.mcap -o merged2.mcap").exit_code, 0);
  EXPECT_EQ(hash_of("merged2.mcap"), hash_of("whole.mcap"));

  // Parts of another recording would be merged with these.
  expect_failure(scene + "-o part.mcap --split 1", 1, {"part-0001.mcap", "already exists", "--force"});
  EXPECT_EQ(run(scene + "-o part.mcap --split 1 --force").exit_code, 0);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "part-0003.mcap"));
}

TEST_F(Recording, StopsBeforeTheFileIsLargerThanAllowed) {
  const test::Outcome outcome = run("vestige record --max-size 1MB --duration 20 -o small.mcap");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.standard_error, HasSubstr("stopped by --max-size after"));
  EXPECT_LE(std::filesystem::file_size(folder_ / "small.mcap"), 1'000'000U);
  EXPECT_EQ(json_of("vestige inspect small.mcap --json -")["complete"], true);
  expect_failure("vestige record --max-size 10kB -o tiny.mcap", 1, {"tiny.mcap", "too few"}, "tiny.mcap");
}

TEST_F(Recording, OfLinesThatFindNoRoomSaysSo) {
  const test::Outcome outcome =
      run("yes '{}' | head -n 20000 | vestige record --live - --compression none --max-size 1MB -o small.mcap");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.standard_error, HasSubstr("stopped by --max-size after"));
  EXPECT_LE(std::filesystem::file_size(folder_ / "small.mcap"), 1'000'000U);
  EXPECT_EQ(json_of("vestige inspect small.mcap --json -")["complete"], true);
}

TEST_F(Recording, IntoAFileWhoseNameIsNoTextIsAsGoodAsAny) {
  const std::string command = "vestige record --duration 0.01 -o \"$(printf '\\377.mcap')\" --json named.json";
  EXPECT_EQ(run(command).exit_code, 0);
  EXPECT_EQ(json_in("named.json")["frames"], 10);
  EXPECT_EQ(run("vestige export *.mcap -o tables && vestige import tables -o \"$(printf '\\376.mcap')\"").exit_code, 0);
}

TEST_F(Recording, OfALineWithANumberBeyondFloatsLeavesItOut) {
  const test::Outcome outcome = run(
      "printf '{\"pose\":{\"joints\":{\"pelvis\":{\"t\":[1e39,0,0]}}}}\\n{}\\n' | vestige record --live - -o a.mcap");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.standard_error, HasSubstr("line 1: 't' has a number that does not fit into a float"));
}

TEST_F(Recording, OfARingIsItsLastSeconds) {
  ASSERT_EQ(run("vestige record --ring 0.25 --rate 100 --duration 3 -o last.mcap").exit_code, 0);
  const auto frames = frames_of("last.mcap");
  ASSERT_EQ(frames.size(), 26U);
  EXPECT_EQ(frames.front().index, 274U);
  EXPECT_EQ(frames.back().index, 299U);
}

TEST_F(Recording, OfARingThatHasNoRoomForItsSecondsSaysSo) {
  const test::Outcome outcome = run("vestige record --ring 1000 --max-size 3MiB --duration 4 -o cut.mcap");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.standard_error,
              HasSubstr("--max-size 3MiB holds less than 1000 s: the trace has only the last "));
  EXPECT_EQ(frames_of("cut.mcap").back().index, 3999U);
  EXPECT_EQ(run("vestige record --ring 1000 --duration 0.1 -o whole.mcap").standard_error, "");
}

TEST_F(Recording, RefusesFlagsThatContradictEachOther) {
  for (const auto& [flags, named] : std::vector<std::pair<std::string, std::string>>{
           {"--ring 5 --json a-0001.mcap", "a-0001.mcap"},
           {"--split 5 --json ./a-0017.mcap", "a-0017.mcap"},
           {"--ring 5 --split 5", "--split"},
           {"--ring 5 --sync", "--sync"},
           {"--split 1MB --max-size 1MB", "--max-size"},
           {"--ring 5 --max-size 1kB", "--max-size"},
           {"--max-size nothing", "--max-size"},
           {"--max-size -5", "--max-size"},
           {"--split 5parsec", "--split"},
           {"--split 1e-9", "--split"},
           {"--ring -1", "--ring"},
           {"--live vmc://nowhere", "--live"},
           {"--live tcp://127.0.0.1:5", "--live"},
           {"--live - --rate 60", "--rate"},
           {"--live - --colliders rain", "--colliders"},
           {"--live - --count 5", "--count"},
           {"--live - --ignore-morphs", "--ignore-morphs"},
           {"--live - --origin 1,0,0", "--origin"},
           {"--live - --at 1,0,0", "--at"},
           {"--live - --limbs all", "--limbs"},
           {"--live vmc://127.0.0.1:39539 --animation walk", "--animation"},
           {"--avatar builtin --live vmc://127.0.0.1:39539 --avatar builtin", "person 2 has none"},
           {"--avatar builtin --live - --avatar builtin --live vmc://127.0.0.1:39539", "of one person"},
           {"--avatar builtin --live vmc://127.0.0.1:39539 --avatar builtin --live vmc://127.0.0.1:39539", "port"}})
    expect_failure("vestige record -o a.mcap " + flags, 2, {named}, "a.mcap");
  expect_failure("vestige record --split 5 -o -", 2, {"--split"});
}

TEST_F(Recording, ShorterThanAFrameIsWarnedOf) {
  const test::Outcome outcome = run("vestige record --rate 100 --duration 0.005 -o short.mcap");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.standard_error, HasSubstr("--duration is shorter than a frame lasts at this --rate"));
  EXPECT_EQ(frames_of("short.mcap").size(), 1U);
  EXPECT_EQ(run("vestige record --rate 100 --duration 0.01 -o one.mcap").standard_error, "");
}

TEST_F(Recording, OfVeryManyFramesIsWarnedOf) {
  const test::Outcome outcome = run("vestige record --rate 1e9 --max-size 1MB -o long.mcap");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.standard_error, HasSubstr("2000000000 frames will take long"));
}

TEST_F(Recording, OfLinesIsWhatTheyCameFrom) {
  ASSERT_EQ(
      run("vestige record --colliders rain --count 40 --rate 200 --duration 1 --origin 7,0,-3 -o man.mcap").exit_code,
      0);
  write("man.ndjson", lines_of("man.mcap"));
  const test::Outcome outcome = run("vestige record --live - -o again.mcap < man.ndjson");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.standard_error;
  EXPECT_EQ(hash_of("again.mcap"), hash_of("man.mcap"));
  EXPECT_TRUE(lines_of("again.mcap") == lines_of("man.mcap"));
}

TEST_F(Recording, OfLinesCountsThoseThatItCannotRead) {
  ASSERT_EQ(run("vestige record --rate 50 --duration 1 -o man.mcap").exit_code, 0);
  write("man.ndjson", lines_of("man.mcap") + "nonsense\n{\"frame\":3}\n{\"time_s\":5}\n");
  const test::Outcome outcome = run("vestige record --live - -o again.mcap < man.ndjson");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.standard_error, HasSubstr("line 51: "));
  EXPECT_THAT(outcome.standard_error, HasSubstr("left out 2 lines that could not be read"));
  EXPECT_THAT(outcome.standard_output, HasSubstr("51 frames"));
  const auto json = json_of("vestige inspect again.mcap --json -");
  EXPECT_EQ(json["dropped"], 4);
  EXPECT_EQ(json["dropped_by_topic"]["/pose"], 2);
  EXPECT_THAT(run("vestige inspect again.mcap").standard_output, HasSubstr("lost 4 messages while recording"));
}

TEST_F(Recording, OfNothingIsNoTrace) {
  expect_failure("vestige record --live - -o a.mcap < /dev/null", 1, {"standard input", "no frame arrived"}, "a.mcap");
  expect_failure("echo nonsense | vestige record --live - --ring 5 -q -o a.mcap", 1, {"no frame arrived"}, "a.mcap");
}

/// The source stalls: what it sent is in the file before it goes on, or ends.
TEST_F(Recording, OfASourceThatStallsIsOnDiskMeanwhile) {
  const test::Outcome outcome =
      run("{ printf '{}\\n{}\\n{}\\n'; for i in $(seq 100); do sleep 0.1; "
          "vestige inspect live.mcap --json - 2>/dev/null | grep -q '\"messages\": 6' && exec touch seen; done; } | "
          "vestige record --live - -o live.mcap");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.standard_error;
  EXPECT_TRUE(std::filesystem::exists(folder_ / "seen"));
}

TEST_F(Recording, UnderNohupOutlivesItsTerminal) {
  const test::Outcome outcome =
      run("{ echo '{}'; for i in $(seq 200); do [ -s live.mcap ] && break; sleep 0.05; done; kill -HUP $(cat pid); "
          "sleep 0.3; echo '{}'; } | "
          "sh -c 'trap \"\" HUP; echo $$ >pid; exec vestige record --live - -o live.mcap'");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.standard_error;
  EXPECT_EQ(frames_of("live.mcap").size(), 2U);
}

TEST_F(Recording, OfTheVmcProtocolIsWhatWasSent) {
  const std::uint16_t port = test::free_udp_port();
  test::BackgroundProcess recorder({"vestige", "record", "--live", fmt::format("vmc://127.0.0.1:{}", port), "--rate",
                                    "100", "-v", "-o", (folder_ / "vr.mcap").string()},
                                   folder_ / "error");
  const test::UdpSender sender(port);
  const std::vector<std::byte> garbage(5, std::byte{'/'});
  std::optional<float> sent_with_garbage;
  for (int i = 0; i < 3000; ++i) {
    const auto x = static_cast<float>(i);
    sender.send(test::bundle({test::bone("Hips", {1, 0, 0, 0}, {0, 0.95, 0}), test::bone("Tail", {1, 0, 0, 0}),
                              test::bone("LeftUpperArm", glm::angleAxis(0.5, glm::dvec3(0, 0, 1))),
                              test::collider(5, x, 2, 3)}));
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    const auto so_far = frames_so_far("vr.mcap");
    if (!so_far.empty() && !sent_with_garbage) {
      sender.send(garbage);
      sent_with_garbage = x;
    }
    if (so_far.size() < 20) continue;
    const auto& colliders = so_far.back().colliders;
    if (!colliders.empty() && colliders[0].position_m.x > std::max(*sent_with_garbage, 5.0F)) break;
  }
  recorder.signal(SIGINT);
  EXPECT_EQ(recorder.wait(), 3);
  const std::string error = read_text_file(folder_ / "error");
  EXPECT_THAT(error, HasSubstr("1 datagram that could not be read"));
  EXPECT_THAT(error, HasSubstr("Hips, LeftUpperArm"));
  EXPECT_THAT(error, HasSubstr("lacks: Tail"));
  const auto frames = frames_of("vr.mcap");
  ASSERT_GE(frames.size(), 20U);
  float last = -1;
  for (const TraceFrame& frame : frames) {
    EXPECT_EQ(frame.time_ns, static_cast<std::int64_t>(frame.index) * 10'000'000);
    ASSERT_EQ(frame.colliders.size(), 1U);
    EXPECT_EQ(frame.colliders[0].id, 5U);
    EXPECT_GE(frame.colliders[0].position_m.x, double{last});
    last = static_cast<float>(frame.colliders[0].position_m.x);
  }
  EXPECT_GT(last, 5) << "the state moves on";
  const auto json = json_of("vestige inspect vr.mcap --json -");
  EXPECT_EQ(json["complete"], true);
  EXPECT_EQ(json["dropped_by_topic"]["input"], 1);
}

TEST_F(Recording, OfTwoPeopleHearsEachOnAPortOfTheirOwn) {
  const std::uint16_t ann_port = test::free_udp_port();
  std::uint16_t bob_port = test::free_udp_port();
  while (bob_port == ann_port) bob_port = test::free_udp_port();
  test::BackgroundProcess recorder({"vestige",  "record",
                                    "--avatar", "builtin",
                                    "--name",   "ann",
                                    "--live",   fmt::format("vmc://127.0.0.1:{}", ann_port),
                                    "--avatar", "builtin",
                                    "--name",   "bob",
                                    "--limbs",  "hand_right",
                                    "--at",     "0,0,0.5,180",
                                    "--live",   fmt::format("vmc://127.0.0.1:{}", bob_port),
                                    "--rate",   "100",
                                    "-o",       (folder_ / "two.mcap").string()},
                                   folder_ / "error");
  const test::UdpSender ann(ann_port);
  const test::UdpSender bob(bob_port);
  const auto frames_now = [&] {
    std::vector<TraceFrame> frames;
    try {
      TraceReader reader(folder_ / "two.mcap", People::kSeveral);
      for (TraceFrame frame; reader.next(frame);) frames.push_back(frame);
    } catch (const Error&) {
      // It has not begun.
    }
    return frames;
  };
  for (int i = 0; i < 3000 && frames_now().size() < 60; ++i) {
    ann.send(test::bundle({test::collider(5, 1, 2, 3), test::collider(6, 0, 0, 0)}));
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    if (frames_now().empty()) continue;  // Ann is the first
    bob.send(
        test::bundle({test::bone("LeftUpperArm", glm::angleAxis(0.5, glm::dvec3(0, 0, 1))), test::collider(6, 9, 9, 9),
                      test::collider(7, 1, 2, 3), test::with_id("/vestige/teleport", 6)}));
  }
  recorder.signal(SIGINT);
  EXPECT_EQ(recorder.wait(), 3) << read_text_file(folder_ / "error");
  EXPECT_THAT(read_text_file(folder_ / "error"), HasSubstr("several sources sent colliders of one id"));
  const std::vector<TraceFrame> frames = frames_now();
  ASSERT_GE(frames.size(), 20U);
  const TraceFrame& last = frames.back();
  ASSERT_EQ(last.poses.size(), 2U);
  for (const TraceFrame& frame : frames) EXPECT_THAT(frame.teleported, ::testing::IsEmpty()) << "that was another 6";
  EXPECT_EQ(last.poses[1].origin_m, glm::dvec3(0, 0, 0.5));
  const auto differ = [&](const char* name) {
    const Avatar avatar = test::builtin_avatar();
    const std::size_t node = avatar.humanoid.node_of.find(name)->second;
    return last.poses[0].nodes[node].rotation != last.poses[1].nodes[node].rotation;
  };
  EXPECT_TRUE(differ("LeftUpperArm"));
  EXPECT_FALSE(differ("RightUpperArm"));
  std::map<std::uint32_t, ColliderSample> colliders;
  for (const ColliderSample& collider : last.colliders) colliders[collider.id] = collider;
  EXPECT_EQ(colliders[5].position_m, glm::dvec3(1, 2, 3));
  EXPECT_EQ(colliders[6].position_m, glm::dvec3(0, 0, 0)) << "the first sender's";
  EXPECT_NEAR(colliders[7].position_m.x, -1, 1e-9) << "where the second sender stands";
  EXPECT_NEAR(colliders[7].position_m.z, 0.5 - 3, 1e-9);
  EXPECT_GT(std::ranges::count(last.colliders, 2, &ColliderSample::owner), 0);
}

TEST_F(Recording, OfARingOutlivesASnapshotThatFails) {
  std::filesystem::create_directory(folder_ / "last-0001.mcap");
  const std::uint16_t port = test::free_udp_port();
  test::BackgroundProcess recorder({"vestige", "record", "--live", fmt::format("vmc://127.0.0.1:{}", port), "--rate",
                                    "100", "--ring", "60", "--force", "-o", (folder_ / "last.mcap").string()},
                                   folder_ / "error");
  const test::UdpSender sender(port);
  int listened = 0;
  for (int i = 0; i < 3000 && listened < 400; ++i) {
    sender.send(test::collider(5, 1, 2, 3));
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    // Before it listens, the signal would end it.
    if (listened > 0 || read_text_file(folder_ / "error").find("listening") != std::string::npos) ++listened;
    if (listened == 50) recorder.signal(SIGUSR1);
  }
  recorder.signal(SIGTERM);
  EXPECT_EQ(recorder.wait(), 1);
  EXPECT_THAT(read_text_file(folder_ / "error"), HasSubstr("last-0001.mcap"));
  EXPECT_GT(frames_of("last.mcap").size(), 0U);
}

TEST_F(Recording, WithVizReplaysToTheSame) {
  const std::string scene = "vestige record --count 20 --rate 200 --duration 1 ";
  ASSERT_EQ(run(scene + "-o plain.mcap && " + scene + "--viz -o seen.mcap").exit_code, 0);
  EXPECT_EQ(hash_of("seen.mcap"), hash_of("plain.mcap"));
  const auto channels = json_of("vestige inspect seen.mcap --json -")["channels"];
  ASSERT_EQ(channels.size(), 4U);
  EXPECT_EQ(channels[2]["schema"], "foxglove.FrameTransforms");
  EXPECT_EQ(channels[3]["messages"], 60);
  EXPECT_EQ(run("vestige doctor seen.mcap").exit_code, 0);
}

}  // namespace
}  // namespace vestige
