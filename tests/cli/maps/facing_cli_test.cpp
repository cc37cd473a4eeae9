// '--facing', and what is found without it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "tests/support/command_line.hpp"
#include "tests/support/made/made_avatars.hpp"
#include "traces/files/input_file.hpp"

namespace vestige {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// A folder with turned.glb, which faces -x, and unnamed.glb, the same without names of joints.
class FacingFlag : public test::CommandLineTest {
 protected:
  FacingFlag() {
    const std::vector<std::byte> turned = test::turned_glb(builtin_avatar_glb(), 3);
    write("turned.glb", turned);
    write("unnamed.glb", test::edited_glb(turned, [](nlohmann::json& json) {
            for (nlohmann::json& node : json["nodes"]) node["name"] = "joint";
          }));
  }
  std::string message(const std::string& command) const { return run(command).standard_error; }

  static constexpr const char* kDoubt =
      "unnamed.glb: neither its joints' names nor VRM tell which way it faces; +z is taken; --facing sets it";
};

TEST_F(FacingFlag, IsNotNeededWhereTheJointsTell) {
  const auto avatar = json_of("vestige avatar turned.glb --json -");
  EXPECT_EQ(avatar["facing"], "-x");
  EXPECT_EQ(avatar["facing_by"], "sides");
  EXPECT_THAT(run("vestige avatar turned.glb").standard_output,
              HasSubstr("faces          -x, by its left and right joints"));
  EXPECT_EQ(json_of("vestige map make --avatar turned.glb --layout torso16 -o t.png --json -")["facing"], "-x");
  EXPECT_EQ(nlohmann::json::parse(read_text_file(folder_ / "t.json"))["facing"], "-x");
  EXPECT_EQ(json_of("vestige map check t.png --avatar turned.glb --json -")["good"], true);
}

TEST_F(FacingFlag, SaysWhatNothingElseTells) {
  EXPECT_THAT(message("vestige avatar unnamed.glb"), HasSubstr(kDoubt));
  EXPECT_THAT(message("vestige avatar unnamed.glb --facing -x"), Not(HasSubstr("--facing")));
  EXPECT_THAT(message("vestige map make --avatar unnamed.glb --layout torso16 -o a.png"), HasSubstr(kDoubt));
  EXPECT_THAT(message("vestige map make --avatar unnamed.glb --facing -x --layout torso16 -o b.png"),
              Not(HasSubstr("--facing")));
  // Of the same body, with its facing told: a layout's left is left, which the names of the other file show.
  EXPECT_EQ(run("vestige map check b.png --avatar turned.glb").exit_code, 0);
  const test::Outcome wrong = run("vestige map check a.png --avatar turned.glb");
  EXPECT_EQ(wrong.exit_code, 4);
  EXPECT_THAT(wrong.standard_output, HasSubstr("the map was made for an avatar that faces +z, and this one faces -x"));
  EXPECT_THAT(wrong.standard_output, HasSubstr("'chest right' lies"));
  EXPECT_THAT(wrong.standard_output, HasSubstr("make the map anew with --facing -x, or rename its regions"));
  EXPECT_THAT(message("vestige avatar turned.glb --facing +z"),
              HasSubstr("turned.glb: its left and right joints say that it faces -x; +z is taken, as asked"));
  EXPECT_THAT(wrong.standard_output, HasSubstr("on the side of the joints named left"));
}

/// The trace keeps the facing: a layout that is laid onto its avatar later is the one that the recording would have
/// had.
TEST_F(FacingFlag, GoesWithTheTrace) {
  const std::string scene = " --avatar unnamed.glb --colliders punch --count 16 --rate 100 --duration 2";
  EXPECT_THAT(message("vestige record" + scene + " --map torso16 -o assumed.mcap"), HasSubstr(kDoubt));
  EXPECT_EQ(message("vestige record -q" + scene + " --facing -x --map torso16 -o now.mcap"), "");
  EXPECT_EQ(json_of("vestige inspect now.mcap --json -")["session"]["facing"], "-x");
  EXPECT_EQ(json_of("vestige inspect assumed.mcap --json -")["session"]["facing"], "+z");
  const auto hash = [&](const std::string& replay) {
    return json_of("vestige replay --map-at 0=torso16 --json - " + replay)["texture_hash"];
  };
  EXPECT_EQ(hash("now.mcap"), json_of("vestige replay now.mcap --json -")["texture_hash"]);
  EXPECT_NE(hash("now.mcap"), hash("assumed.mcap"));
  ASSERT_EQ(run("vestige trim now.mcap --to 1 -o part.mcap && vestige export now.mcap -o now.h5 && "
                "vestige import now.h5 -o again.mcap")
                .exit_code,
            0);
  for (const char* file : {"part.mcap", "again.mcap"})
    EXPECT_EQ(json_of(std::string("vestige inspect --json - ") + file)["session"]["facing"], "-x") << file;
}

TEST_F(FacingFlag, OfAMapIsTakenWhereNothingElseTellsAndComparedOtherwise) {
  ASSERT_EQ(run("vestige map make --avatar unnamed.glb --facing -x --layout torso16 -o told.png").exit_code, 0);
  EXPECT_EQ(message("vestige record -q --avatar unnamed.glb --map told.png --duration 0.1 -o told.mcap"), "");
  EXPECT_EQ(json_of("vestige inspect told.mcap --json -")["session"]["facing"], "-x");
  // Through a folder of CSV files, too.
  ASSERT_EQ(run("vestige export told.mcap -o told && vestige import told -o again.mcap").exit_code, 0);
  EXPECT_EQ(json_of("vestige inspect again.mcap --json -")["session"]["facing"], "-x");
  ASSERT_EQ(run("vestige map make --avatar unnamed.glb --facing +z --layout torso16 -o wrong.png").exit_code, 0);
  EXPECT_THAT(
      message("vestige record --avatar turned.glb --map wrong.png --duration 0.1 -o wrong.mcap"),
      HasSubstr("wrong.png: was made for an avatar that faces +z, and turned.glb faces -x, by its left and right "
                "joints; make it anew, or set --facing"));
}

TEST_F(FacingFlag, IsOneForAllTracesOfABatch) {
  const std::string scene = "vestige record -q --avatar unnamed.glb --map none --colliders punch --duration 0.3 ";
  ASSERT_EQ(run(scene + "--facing -x -o a.mcap; " + scene + "--facing +z -o b.mcap").exit_code, 0);
  const test::Outcome batch = run("vestige batch --maps torso16 --traces a.mcap b.mcap -o both");
  EXPECT_NE(batch.exit_code, 0);
  EXPECT_THAT(batch.standard_error,
              HasSubstr("b.mcap: records that its avatar faces +z, and that of the batch faces -x"));
  ASSERT_EQ(run("vestige batch --maps torso16 --traces a.mcap --avatar unnamed.glb -o one").exit_code, 0);
  EXPECT_EQ(json_in("one/run.json")["batch"]["avatar"]["facing"], "-x");
  EXPECT_EQ(json_in("one/maps/torso16.json")["facing"], "-x");
}

/// A map that takes the place of a trace's own.
TEST_F(FacingFlag, OfAMapIsComparedWithThatOfATraceOnce) {
  ASSERT_EQ(run("vestige record -q --avatar turned.glb --map torso16 --colliders punch --duration 0.1 -o t.mcap && "
                "vestige map make -q --avatar unnamed.glb --facing +z --layout torso16 -o wrong.png && "
                "vestige map make -q --avatar turned.glb --layout torso16 -o right.png")
                .exit_code,
            0);
  const std::string warning =
      "wrong.png: was made for an avatar that faces +z, and t.mcap faces -x, by the trace; make it anew\n";
  for (const std::string verb :
       {"replay t.mcap --map-at 0=", "stream t.mcap --port - --map ", "plot body t.mcap --force -o b --map ",
        "plot scene t.mcap --force -o s --map ", "plot paraview t.mcap --force -o p --map "}) {
    const std::string said = message("vestige " + verb + "wrong.png");
    const std::size_t at = said.find(warning);
    ASSERT_NE(at, std::string::npos) << verb << "\n" << said;
    EXPECT_EQ(said.find("was made for", at + warning.size()), std::string::npos) << verb << "\n" << said;
  }
  for (const std::string verb : {"replay t.mcap --map-at 0=", "stream t.mcap --port - --map "})
    EXPECT_THAT(message("vestige " + verb + "right.png"), Not(HasSubstr("was made for"))) << verb;
}

/// A figure shows the front where the joints say that it is, whatever a map says.
TEST_F(FacingFlag, OfAMapTurnsAFigureOnlyWhereNothingElseTells) {
  ASSERT_EQ(run("vestige map make -q --avatar unnamed.glb --facing +z --layout torso16 -o wrong.png && "
                "vestige map make -q --avatar unnamed.glb --facing -x --layout torso16 -o told.png && "
                "cp wrong.png silent.png && sed '/facing/d' wrong.json >silent.json && mkdir named && "
                "cp turned.glb named/unnamed.glb")
                .exit_code,
            0);
  const auto figure = [&](const std::string& flags, const std::string& expected) {
    const std::string said = message("vestige plot body --force -o f " + flags);
    EXPECT_EQ(said.find("warning") == std::string::npos, expected.empty()) << flags << "\n" << said;
    EXPECT_THAT(said, HasSubstr(expected)) << flags;
    return read_text_file(folder_ / "f.svg");
  };
  const std::string by_joints = figure("--avatar turned.glb --map silent.png", "");
  EXPECT_TRUE(figure("--avatar turned.glb --map wrong.png",
                     "wrong.png: was made for an avatar that faces +z, and turned.glb faces -x, by its left and right "
                     "joints; make it anew, or set --facing") == by_joints);
  EXPECT_TRUE(figure("--avatar unnamed.glb --map told.png", "") ==
              figure("--avatar named/unnamed.glb --map told.png", ""));
}

TEST_F(FacingFlag, TurnsFigures) {
  ASSERT_EQ(run("vestige map make -q --avatar turned.glb --layout torso16 -o map.png && sed -i '/facing/d' map.json && "
                "mkdir named && cp turned.glb named/unnamed.glb")
                .exit_code,
            0);
  for (const std::string command :
       {"vestige plot avatar --force --animation none ", "vestige map preview --force map.png --avatar "}) {
    const auto figure = [&](const std::string& flags, const std::string& expected) {
      const std::string said = message(command + flags + " -o f");
      EXPECT_EQ(said.find("warning") == std::string::npos, expected.empty()) << command << flags << "\n" << said;
      EXPECT_THAT(said, HasSubstr(expected)) << command << flags;
      return read_text_file(folder_ / "f.svg");
    };
    const std::string named = figure("named/unnamed.glb", "");
    EXPECT_TRUE(figure("unnamed.glb --facing -x", "") == named) << command;
    EXPECT_FALSE(figure("unnamed.glb", kDoubt) == named) << command;
  }
}

/// The folder has no map, whose sidecar could tell.
TEST_F(FacingFlag, GoesThroughAFolderOfCsvWithoutAMap) {
  ASSERT_EQ(run("vestige record -q --avatar unnamed.glb --facing -x --map none --duration 0.1 -o a.mcap && "
                "vestige export a.mcap -q -o a")
                .exit_code,
            0);
  EXPECT_EQ(json_in("a/session.json"), nlohmann::json({{"facing", "-x"}}));
  EXPECT_THAT(message("vestige import a -o b.mcap"), Not(HasSubstr("faces")));
  EXPECT_EQ(json_of("vestige inspect b.mcap --json -")["session"]["facing"], "-x");
  EXPECT_EQ(run("vestige import a --facing +x -o c.mcap").exit_code, 0);
  EXPECT_EQ(json_of("vestige inspect c.mcap --json -")["session"]["facing"], "+x");
  write("a/session.json", std::string("{\"facing\": \"up\"}"));
  EXPECT_THAT(message("vestige import a -o d.mcap"), HasSubstr("the facing 'up', which is no axis; +z is taken"));
  write("a/session.json", std::string("{\"facing\": 3}"));
  expect_failure("vestige import a -o e.mcap", 1, {"a/session.json: is not a JSON object with a text 'facing'"},
                 "e.mcap");
  write("a/session.json", std::string("{"));
  expect_failure("vestige import a -o e.mcap", 1, {"a/session.json", "export the trace again"}, "e.mcap");
}

/// A foreign trace may say what is no axis.
TEST_F(FacingFlag, OfATraceThatIsNoAxisIsAFaultThatRecoverLeavesOut) {
  run("vestige record -q --avatar turned.glb --compression none --duration 0.1 -o a.mcap && cp a.mcap b.mcap && "
      "sed -i 's/facing\\x02\\x00\\x00\\x00-x/facing\\x02\\x00\\x00\\x00qq/g' b.mcap");
  EXPECT_THAT(run("vestige inspect a.mcap").standard_output, HasSubstr("avatar faces         -x, by the trace\n"));
  EXPECT_THAT(run("vestige inspect b.mcap").standard_output, Not(HasSubstr("avatar faces")));
  EXPECT_THAT(message("vestige replay b.mcap"),
              HasSubstr("b.mcap: the trace records the facing 'qq', which is no axis; -x is taken"));
  const auto fault = HasSubstr("the session records the facing 'qq', which is no axis");
  const test::Outcome doctor = run("vestige doctor b.mcap");
  EXPECT_EQ(doctor.exit_code, 3);
  EXPECT_THAT(doctor.standard_output, fault);
  EXPECT_THAT(doctor.standard_output, HasSubstr("`vestige recover` leaves it out"));
  EXPECT_THAT(run("vestige recover b.mcap -o c.mcap").standard_output,
              HasSubstr("the session's facing 'qq', which is no axis, was left out"));
  EXPECT_FALSE(json_of("vestige inspect c.mcap --json -")["session"].contains("facing"));
  EXPECT_EQ(run("vestige doctor c.mcap").exit_code, 0);
}

TEST_F(FacingFlag, IsInTheSidecarOfTheBuiltinMap) {
  ASSERT_EQ(run("vestige avatar builtin -q --map-output six.png").exit_code, 0);
  EXPECT_EQ(json_in("six.json")["facing"], "+z");
  EXPECT_EQ(json_in("six.json")["actuators"].size(), 6U);
}

TEST_F(FacingFlag, TakesAnAxis) {
  const test::Outcome wrong = run("vestige record --facing up -o a.mcap");
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.standard_error, HasSubstr("--facing: up not in {+z,+x,-z,-x,auto}"));
  // The other program checks its command line in the same way.
  expect_failure("vestige-plot avatar unnamed.glb --facing=", 2, {"--facing=: has no value behind the equals sign"});
  expect_failure("vestige-plot avatar unnamed.glb --facing +z --facing -x", 2, {"--facing: is given 2 times"});
}

}  // namespace
}  // namespace vestige
