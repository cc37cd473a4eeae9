// Traces that leave for other programs and come back, as a user moves them.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "tests/cli/files/exchange_fixture.hpp"
#include "tests/support/long.hpp"
#include "tests/support/npm.hpp"
#include "tests/traces/motion/made_motion.hpp"
#include "traces/exchange/pose_csv.hpp"

namespace vestige {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

/// A walk of two frames on a skeleton of Mixamo's names, in centimetres.
constexpr const char* kWalk = R"(HIERARCHY
ROOT mixamorig:Hips
{
  OFFSET 0 100 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT mixamorig:Spine
  {
    OFFSET 0 10 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    JOINT mixamorig:Neck
    {
      OFFSET 0 40 0
      CHANNELS 3 Zrotation Xrotation Yrotation
      JOINT mixamorig:Head
      {
        OFFSET 0 10 0
        CHANNELS 3 Zrotation Xrotation Yrotation
        End Site
        {
          OFFSET 0 20 0
        }
      }
    }
  }
  JOINT mixamorig:LeftUpLeg
  {
    OFFSET 10 -5 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    JOINT mixamorig:LeftLeg
    {
      OFFSET 0 -45 0
      CHANNELS 3 Zrotation Xrotation Yrotation
      JOINT mixamorig:LeftFoot
      {
        OFFSET 0 -45 0
        CHANNELS 3 Zrotation Xrotation Yrotation
        End Site
        {
          OFFSET 0 -5 10
        }
      }
    }
  }
  JOINT mixamorig:RightUpLeg
  {
    OFFSET -10 -5 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    JOINT mixamorig:RightLeg
    {
      OFFSET 0 -45 0
      CHANNELS 3 Zrotation Xrotation Yrotation
      JOINT mixamorig:RightFoot
      {
        OFFSET 0 -45 0
        CHANNELS 3 Zrotation Xrotation Yrotation
        End Site
        {
          OFFSET 0 -5 10
        }
      }
    }
  }
}
MOTION
Frames: 3
Frame Time: 0.05
0 100 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0
0 100 20 0 0 0 0 0 0 0 0 0 0 0 0 0 -30 0 0 20 0 0 0 0 0 20 0 0 0 0 0 0 0
0 100 40 0 0 0 0 0 0 0 0 0 0 0 0 0 20 0 0 0 0 0 0 0 0 -30 0 0 20 0 0 0 0
)";

class Exchange : public test::ExchangeTest {};

TEST_F(Exchange, CsvAndBackIsTheSameTraceToTheBit) {
  ASSERT_EQ(run("vestige export a.mcap -o there").exit_code, 0);
  ASSERT_EQ(run("vestige import there -o back.mcap").exit_code, 0);
  EXPECT_EQ(run("vestige cat a.mcap > a.txt; vestige cat back.mcap > back.txt; cmp a.txt back.txt").exit_code, 0);
  EXPECT_EQ(hash_of("back.mcap"), hash_of("a.mcap"));
  const auto inspected = json_of("vestige inspect back.mcap --json -");
  EXPECT_EQ(inspected["attachments"].size(), json_of("vestige inspect a.mcap --json -")["attachments"].size());
}

TEST_F(Exchange, CsvLeavesNoMapOfTheExportBefore) {
  ASSERT_EQ(run("vestige record --map none --duration 0.05 -o no_map.mcap && vestige export a.mcap -o there").exit_code,
            0);
  ASSERT_TRUE(exists("there/actuator_map.png"));
  expect_failure("vestige export no_map.mcap -o there", 1, {"already exists"});
  EXPECT_TRUE(exists("there/actuator_map.json"));
  const auto report = json_of("vestige export no_map.mcap -o there --force --json -");
  EXPECT_THAT(report["outputs"],
              ElementsAre("there/poses.csv", "there/colliders.csv", "there/avatar.glb", "there/session.json"));
  EXPECT_FALSE(exists("there/actuator_map.png"));
  EXPECT_FALSE(exists("there/actuator_map.json"));
  ASSERT_EQ(run("vestige import there -o back.mcap").exit_code, 0);
  EXPECT_EQ(json_of("vestige inspect back.mcap --json -")["attachments"].size(), 1U);
}

TEST_F(Exchange, CsvColumnsHaveNamesOfTheirOwnWhateverTheNodesAreCalled) {
  EXPECT_THAT(pose_csv_nodes({"hips", "", "dup", "a\nb", "dup"}), ElementsAre("hips", "#1", "dup#2", "a b", "dup#4"));
  EXPECT_THAT(pose_csv_nodes({"dup", "dup", "dup#1", "dup#1#2", "#5", ""}),
              ElementsAre("dup#0", "dup#1", "dup#1#2", "dup#1#2#3", "#5#4", "#5"));
  EXPECT_THAT(pose_csv_nodes({"e\nf", "e f", "e\rf#0"}), ElementsAre("e f#0", "e f#1", "e f#0#2"));
  const std::vector<std::string> nodes = pose_csv_nodes({"a#1", "a", "a", "a#2", "a#1#0", "a#1#0#4", "a#2#3", ""});
  EXPECT_EQ(std::set<std::string>(nodes.begin(), nodes.end()).size(), nodes.size());
}

TEST_F(Exchange, MistakesInCollidersAdviseTheColumnsThatTheTableHas) {
  write("frames.csv", "frame,time_s,id,x,y,z,teleported\n0,0,1,0,0,x,0\n");
  expect_failure("vestige record --colliders frames.csv -o b.mcap", 1,
                 {"frames.csv, line 2", "each row is frame,time_s,id,x,y,z,teleported"}, "b.mcap");
  write("times.csv", "time_s,id,x,y,z\n0,1,0,0,x\n");
  expect_failure("vestige record --colliders times.csv -o b.mcap", 1,
                 {"times.csv, line 2", "each row is time_s,id,x,y,z:"}, "b.mcap");
}

TEST_F(Exchange, CsvOfOneTableGoesToAFileOrStandardOutput) {
  EXPECT_EQ(run("vestige export a.mcap -o - --format csv --what colliders | head -1").standard_output,
            "frame,time_s,id,x,y,z,teleported\n");
  // Who needs no more is no failure.
  const test::Outcome cut = run("(vestige export a.mcap -o - --format csv --what colliders; echo $? >code) | head -1");
  EXPECT_EQ(cut.standard_error, "");
  EXPECT_EQ(run("cat code").standard_output, "0\n");
  ASSERT_EQ(run("vestige export a.mcap -o poses.csv --what poses").exit_code, 0);
  EXPECT_EQ(run("wc -l < poses.csv").standard_output, "301\n");
  // Poses by standard input, and colliders that say only when they are where.
  write("points.csv", "time_s,id,x,y,z\n0,7,1,2,3\n1.495,7,1,2,4\n");
  EXPECT_EQ(run("vestige import --poses - --colliders points.csv -o b.mcap < poses.csv").exit_code, 0);
  EXPECT_EQ(json_of("vestige replay b.mcap --json -")["colliders"], 1);
  expect_failure("vestige export a.mcap -o both.csv", 2, {"--what poses"}, "both.csv");
  expect_failure("vestige export a.mcap -o -", 2, {"--format"});
}

TEST_F(Exchange, ExportedCollidersCanBeRecordedWithAgain) {
  ASSERT_EQ(run("vestige export a.mcap -o rain.csv --what colliders").exit_code, 0);
  ASSERT_EQ(run("vestige record --colliders rain.csv --rate 200 --duration 1.5 -o b.mcap").exit_code, 0);
  ASSERT_EQ(run("vestige export b.mcap -o again.csv --what colliders").exit_code, 0);
  EXPECT_EQ(run("cmp rain.csv again.csv").exit_code, 0);
}

TEST_F(Exchange, NdjsonHasALineAFrame) {
  ASSERT_EQ(run("vestige export a.mcap -o a.ndjson").exit_code, 0);
  EXPECT_EQ(run("wc -l < a.ndjson").standard_output, "300\n");
  const auto line = nlohmann::json::parse(run("sed -n 2p a.ndjson").standard_output);
  EXPECT_EQ(line["frame"], 1);
  EXPECT_EQ(line["time_s"], 0.005);
  EXPECT_EQ(line["colliders"].size(), 30U);
  const auto pose = nlohmann::json::parse(run("vestige cat a.mcap --topic /pose | sed -n 2p").standard_output);
  EXPECT_EQ(line["pose"], pose["data"]);
  EXPECT_EQ(run("vestige export - -o - --format ndjson < a.mcap | cmp - a.ndjson").exit_code, 0);
}

TEST_F(Exchange, ImportOntoAFullDiskLeavesNothing) {
  ASSERT_EQ(run("vestige record --colliders swarm --count 100 --rate 200 --duration 3 -o long.mcap && "
                "vestige export long.mcap -o long.h5")
                .exit_code,
            0);
  write("precious.mcap", "precious");
  for (const char* output : {"full.mcap", "precious.mcap"}) {
    // The first chunks can be written.
    const auto outcome =
        run(std::string("ulimit -f 4000; vestige import long.h5 --force --compression none -o ") + output);
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_THAT(outcome.standard_error, HasSubstr(std::string(" ") + output + ": could not write"));
    EXPECT_THAT(outcome.standard_error, Not(HasSubstr("kept")));
  }
  EXPECT_FALSE(exists("full.mcap"));
  EXPECT_EQ(read_text_file(folder_ / "precious.mcap"), "precious");
  EXPECT_EQ(run("ls -A | grep -c partial").standard_output, "0\n");
  expect_no_hidden_file();
}

TEST_F(Exchange, GltfIsValidWhereverTheOriginIs) {
  const auto line = [](const char* time_s, const char* origin) {
    return fmt::format(R"({{"time_s":{},"pose":{{"origin":{},"joints":{{}}}}}})", time_s, origin) + "\n";
  };
  const std::string good = line("0", "[1,2,3]");
  for (const char* origin : {R"(["nan",2,3])", R"([1,"-inf",3])", "[1,2,1e300]"}) {
    const std::string bad = line("0.1", origin);
    for (const std::string& lines : {good + bad + line("0.2", "[1,2,4]"), line("0", origin) + line("0.1", "[1,2,3]")}) {
      record_lines(lines, "far.mcap");
      const auto outcome = run("vestige export far.mcap -o far.glb --force");
      EXPECT_EQ(outcome.exit_code, 3) << lines;
      EXPECT_THAT(outcome.standard_error, HasSubstr("not finite in fp32: 1 value;")) << lines;
      // Which reads its animation, and refuses what is not finite.
      EXPECT_EQ(run("vestige avatar far.glb").exit_code, 0) << lines;
      const auto json = json_of_glb("far.glb");
      const bool starts_well = lines.starts_with(good);
      EXPECT_EQ(json["scenes"][0]["extras"]["origin_m"],
                nlohmann::json(starts_well ? std::vector{1.0, 2.0, 3.0} : std::vector{0.0, 0.0, 0.0}))
          << lines;
    }
  }
}

TEST_F(Exchange, OneIsNotCalledMany) {
  // Both times are the same in fp32.
  record_lines("{\"time_s\":100000,\"colliders\":[{\"id\":1,\"position\":[0,0,0]}]}\n{\"time_s\":100000.000001}\n",
               "two.mcap");
  const auto outcome = run("vestige export two.mcap -o two.glb");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.standard_error,
              HasSubstr("left out 1 frame: rounded to fp32, the time is that of the frame before"));
  ASSERT_EQ(run("vestige export two.mcap -o two --rate 1").standard_output.find("two: 1 frame of 1 collider and "), 0U);
  EXPECT_THAT(run("vestige import two -o one.mcap").standard_output, HasSubstr("one.mcap: 1 frame of "));
}

TEST_F(Exchange, GltfHoldsTheMotionAndTheCollidersAndIsValid) {
  ASSERT_EQ(run("vestige export a.mcap -o a.glb").exit_code, 0);
  const auto avatar = json_of("vestige avatar a.glb --json -");
  ASSERT_EQ(avatar["animations"].size(), 1U);
  EXPECT_NEAR(avatar["animations"][0]["duration_s"].get<double>(), 1.495, 1e-6);
  VESTIGE_REQUIRE_DATA(test::npm_package("gltf-validator"));
  const auto issues = nlohmann::json::parse(test::run_node("validate_gltf.mjs", folder_ / "a.glb"));
  EXPECT_EQ(issues["numErrors"], 0) << issues.dump(2);
  EXPECT_EQ(issues["numWarnings"], 0) << issues.dump(2);
}

TEST_F(Exchange, CollidersThatMoveInAGltfMoveInATrace) {
  // Without teleports, which glTF does not have, and at times that fp32 holds.
  ASSERT_EQ(run("vestige record --colliders swarm --count 20 --rate 128 --duration 1 -o b.mcap && "
                "vestige export b.mcap -o b.glb && "
                "vestige record --colliders b.glb --rate 128 --duration 1 -o c.mcap")
                .exit_code,
            0);
  const auto before = json_of("vestige replay b.mcap --detector cpu --json -");
  const auto after = json_of("vestige replay c.mcap --detector cpu --json -");
  EXPECT_EQ(after["colliders"], 20);
  EXPECT_GT(before["contacts"].get<int>(), 0);
  EXPECT_NEAR(after["contacts"].get<int>(), before["contacts"].get<int>(), 2);
  const auto some =
      run("vestige record --colliders b.glb --nodes 'collider 1*' --rate 128 --duration 1 "
          "-o d.mcap");
  ASSERT_EQ(some.exit_code, 0) << some.standard_error;
  EXPECT_EQ(json_of("vestige replay d.mcap --json -")["colliders"], 11);
  expect_failure("vestige record --colliders b.glb --nodes 'ball*' -o e.mcap", 1, {"ball*", "the file has:"}, "e.mcap");
  expect_failure("vestige record --nodes 'ball*' -o e.mcap", 2, {"--nodes"}, "e.mcap");
}

TEST_F(Exchange, FewerFramesAreExportedAtARate) {
  ASSERT_EQ(run("vestige export a.mcap -o a.ndjson --rate 50").exit_code, 0);
  EXPECT_EQ(run("wc -l < a.ndjson").standard_output, "75\n");
  EXPECT_EQ(nlohmann::json::parse(run("sed -n 2p a.ndjson").standard_output)["time_s"], 0.02);
}

TEST_F(Exchange, MotionCaptureMovesTheBuiltInAvatar) {
  write("walk.bvh", kWalk);
  const auto report = json_of("vestige import --motion walk.bvh -o walk.mcap --json -");
  EXPECT_EQ(report["frames"], 3);
  EXPECT_EQ(report["motion"]["matched"].size(), 11U) << report["motion"].dump(1);
  EXPECT_EQ(report["motion"]["unmatched_joints"].size(), 0U);
  EXPECT_EQ(report["motion"]["likely_unit"], "cm");
  EXPECT_EQ(json_of("vestige inspect walk.mcap --json -")["duration_s"], 0.1);
  EXPECT_EQ(run("vestige import --motion walk.bvh --rate 100 -o faster.mcap").exit_code, 0);
  EXPECT_EQ(json_of("vestige inspect faster.mcap --json -")["messages"], 22);
  const auto other = run("vestige record --animation walk.bvh --rate 100 --duration 0.5 -o record.mcap");
  EXPECT_EQ(other.exit_code, 0) << other.standard_error;
  const auto first_origin = [&](const char* flags) {
    const std::string command =
        std::string("vestige record --animation walk.bvh --rate 100 --duration 0.1 --force ") + flags;
    EXPECT_EQ(run(command + " -o unit.mcap").exit_code, 0) << flags;
    return run("vestige cat unit.mcap | grep /pose | tail -1").standard_output;
  };
  EXPECT_NE(first_origin("--unit m"), first_origin("--unit cm"));
  EXPECT_EQ(first_origin("--unit auto"), first_origin(""));
  expect_failure("vestige record --animation walk --unit cm -o b.mcap", 2, {"--unit", ".bvh"}, "b.mcap");
}

TEST_F(Exchange, WhoLiesInMotionCaptureLiesInTheTrace) {
  // +Z is up, and all bones lie along +X while their rotations are zero.
  write("lying.bvh", test::made_bvh(test::made_motion("lie"), "z", "x"));
  const auto motion = json_of("vestige import --motion lying.bvh -o lying.mcap --json -")["motion"];
  EXPECT_EQ(motion["up"], "+z");
  EXPECT_EQ(motion["up_by"], "floor");
  EXPECT_EQ(motion["deviations"].size(), 0U) << motion.dump(1);
  const auto asked = json_of("vestige import --motion lying.bvh --up y -o standing.mcap --json -")["motion"];
  EXPECT_EQ(asked["up"], "+y");
  EXPECT_EQ(asked["up_by"], "flag");
  const auto recorded = run("vestige record --animation lying.bvh --rate 100 --duration 0.5 --up=-z -o upside.mcap");
  EXPECT_EQ(recorded.exit_code, 0) << recorded.standard_error;
  expect_failure("vestige record --animation walk --up z -o b.mcap", 2, {"--up", ".bvh"}, "b.mcap");
  expect_failure("vestige import --motion lying.bvh --up x -o b.mcap", 2, {"--up"}, "b.mcap");
}

TEST_F(Exchange, ABodyThatLeansAnotherWayIsTakenByForceUnlessThatOverwritesAFile) {
  std::string bow = kWalk;
  bow.replace(bow.find("mixamorig:Spine"), 15, "pole");  // so that the avatar's back stays straight
  bow.replace(bow.find("0 100 20 0 0 0 0 0"), 18, "0 100 20 0 0 0 0 80");
  write("bow.bvh", bow);
  for (const std::string command :
       {"vestige import --motion bow.bvh", "vestige record --animation bow.bvh --duration 0.1"}) {
    expect_failure(
        command + " -o b.mcap", 1,
        {"follows these joints: pole", "bow.bvh: frame 1: from hips to head, the avatar points", "add --force"},
        "b.mcap");
    write("mine.mcap", "mine");
    expect_failure(command + " --force -o mine.mcap", 1, {"bow.bvh: frame 1", "choose a new name for mine.mcap"});
    EXPECT_TRUE(read_text_file(folder_ / "mine.mcap") == "mine");
    const test::Outcome taken = run(command + " --force -o b.mcap");
    EXPECT_EQ(taken.exit_code, 0) << taken.standard_error;
    EXPECT_THAT(taken.standard_error, HasSubstr("hips to head: the avatar's direction differs by up to"));
    std::filesystem::remove(folder_ / "b.mcap");
  }
}

TEST_F(Exchange, JointsOfAnyNameAreNamedBriefly) {
  std::string walk = kWalk;
  walk.replace(walk.find("mixamorig:Spine"), 15, "\x1b[31mtail" + std::string(100'000, 'x'));
  write("long.bvh", walk);
  const auto outcome = run("vestige import --motion long.bvh -v -o long.mcap");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.standard_error, HasSubstr("nothing follows these joints: \\x1b[31mtailx"));
  EXPECT_LT(outcome.standard_error.size(), 10'000U);
  write("dog.bvh", "HIERARCHY\nROOT " + std::string(100'000, 'x') +
                       "\n{\nOFFSET 0 0 0\nCHANNELS 1 Xrotation\n}\nMOTION\nFrames: 1\nFrame Time: 1\n0\n");
  EXPECT_LT(run("vestige import --motion dog.bvh -o b.mcap").standard_error.size(), 1000U);
}

TEST_F(Exchange, WhatIsWrongWithAFileIsSaidByLineAndNothingIsWritten) {
  std::string walk = kWalk;
  write("cut.bvh", walk.substr(0, walk.size() - 3));
  expect_failure("vestige import --motion cut.bvh -o b.mcap", 1, {"cut.bvh, line 69", "channels"}, "b.mcap");
  write("long.bvh", std::string(kWalk).replace(walk.find("Frames: 3"), 9, "Frames: 4000000000"));
  expect_failure("vestige import --motion long.bvh -o b.mcap", 1, {"long.bvh, line", "do not fit"}, "b.mcap");
  write("dog.bvh",
        "HIERARCHY\nROOT tail\n{\nOFFSET 0 0 0\nCHANNELS 1 Xrotation\n}\nMOTION\nFrames: 1\nFrame Time: 1\n0\n");
  expect_failure("vestige import --motion dog.bvh -o b.mcap", 1, {"dog.bvh", "tail", "hips"}, "b.mcap");
  expect_failure("vestige import --motion missing.bvh -o b.mcap", 1, {"missing.bvh"}, "b.mcap");
  write("walk.bvh", kWalk);
  for (const char* rate : {"1e300", "1e11"})
    expect_failure(std::string("vestige import --motion walk.bvh -o b.mcap --rate ") + rate, 2,
                   {"--rate", "at most 4294967295", "lower --rate"}, "b.mcap");
  write("fast.bvh", std::string(kWalk).replace(walk.find("Frame Time: "), 12, "Frame Time: 1e-20\n"));
  expect_failure("vestige import --motion fast.bvh -o b.mcap", 1, {"fast.bvh, line", "less than 1e-9 s"}, "b.mcap");

  ASSERT_EQ(run("vestige export a.mcap -o there").exit_code, 0);
  ASSERT_EQ(run("head -100 there/poses.csv > cut.csv && echo 99,0.6,x >> cut.csv").exit_code, 0);
  expect_failure("vestige import --poses cut.csv -o b.mcap", 1, {"cut.csv, line 101", "origin_x"}, "b.mcap");
  expect_failure("vestige import --poses there/poses.csv --colliders missing.csv -o b.mcap", 1, {"missing.csv"},
                 "b.mcap");
  ASSERT_EQ(run("head -50 there/poses.csv > few.csv").exit_code, 0);
  expect_failure("vestige import --poses few.csv --colliders there/colliders.csv -o b.mcap", 1,
                 {"colliders.csv, line", "has no pose"}, "b.mcap");
  write("node.csv", "time_s,tail.tx\n0,1\n");
  expect_failure("vestige import --poses node.csv -o b.mcap", 1, {"node.csv, line 1", "tail.tx"}, "b.mcap");
  expect_no_hidden_file();
}

/// 30 000 frames are about 120 MB; every way out and back gets by with 96 MiB of data.
TEST_F(Exchange, LongTracesPassThroughLittleMemory) {
#ifdef VESTIGE_SANITIZED
  GTEST_SKIP() << "memory is not measured under sanitizers, which keep what is freed";
#endif
  ASSERT_EQ(run("vestige record --colliders swarm --count 100 --rate 1000 --duration " +
                std::string(test::is_long() ? "30" : "10") + " -o long.mcap")
                .exit_code,
            0);
  const int messages = test::is_long() ? 60000 : 20000;
  const std::string limited = "ulimit -d 65536 && ";
  for (const char* command :
       {"vestige export long.mcap -o long.glb", "vestige export long.mcap -o long.h5",
        "vestige export long.mcap -o long", "vestige export long.mcap -o - --format ndjson | tail -1 | cut -c1-30",
        "vestige import long.h5 -o h5.mcap", "vestige import long -o csv.mcap"}) {
    const test::Outcome outcome = run(limited + command);
    EXPECT_EQ(outcome.exit_code, 0) << command << "\n" << outcome.standard_error;
  }
  EXPECT_EQ(json_of("vestige inspect csv.mcap --json -")["messages"], messages);
  EXPECT_EQ(json_of("vestige inspect h5.mcap --json -")["messages"], messages);
}

TEST_F(Exchange, FlagsThatWouldDoNothingAreRefused) {
  write("walk.bvh", kWalk);
  expect_failure("vestige import -o b.mcap", 2, {"--motion", "--poses"}, "b.mcap");
  expect_failure("vestige import --poses p.csv --rate 5 -o b.mcap", 2, {"--rate"}, "b.mcap");
  expect_failure("vestige import --poses p.csv --unit cm -o b.mcap", 2, {"--unit"}, "b.mcap");
  expect_failure("vestige import --motion walk.bvh --nodes x -o b.mcap", 2, {"--nodes"}, "b.mcap");
  expect_failure("vestige export a.mcap -o a.glb --what poses", 2, {"--what"}, "a.glb");
  expect_failure("vestige export a.mcap -o a.xyz", 2, {"a.xyz", ".ndjson"}, "a.xyz");
  EXPECT_EQ(run("vestige export a.mcap -o there").exit_code, 0);
  expect_failure("vestige export a.mcap -o there", 1, {"already exists"});
  EXPECT_EQ(run("vestige export a.mcap -o there --force").exit_code, 0);
}

}  // namespace
}  // namespace vestige
