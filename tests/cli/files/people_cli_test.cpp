// Several people in one trace, as a user records, looks at and mends it.

#include <algorithm>
#include <cmath>

#include "tests/support/command_line.hpp"
#include "traces/files/input_file.hpp"
#include "traces/trace_file/trace_reader.hpp"

namespace vestige {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class PeopleOfATrace : public test::CommandLineTest {
 protected:
  void record(const std::string& flags, const std::string& trace = "two.mcap") const {
    const test::Outcome outcome =
        run("vestige record --rate 60 --duration 0.5 --count 9 " + flags + " --force -o " + trace);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.standard_error;
  }
  void record_two() const { record("--avatar builtin --name ann --avatar builtin --name bob --at 0,0,0.9,180"); }

  std::vector<TraceFrame> frames_of(const std::string& trace) const {
    TraceReader reader(folder_ / trace, People::kSeveral);
    std::vector<TraceFrame> frames;
    TraceFrame frame;
    while (reader.next(frame)) frames.push_back(frame);
    EXPECT_TRUE(reader.complete()) << trace;
    return frames;
  }
};

TEST_F(PeopleOfATrace, StandWhereTheyWerePut) {
  record_two();
  const std::vector<TraceFrame> frames = frames_of("two.mcap");
  ASSERT_EQ(frames.size(), 30U);
  for (const TraceFrame& frame : frames) {
    ASSERT_EQ(frame.poses.size(), 2U);
    EXPECT_EQ(frame.poses[0].origin_m, glm::dvec3(0));
    EXPECT_NEAR(frame.poses[1].origin_m.z, 0.9, 1e-6);
    const NodeLocal& ann = frame.poses[0].nodes[0];
    const NodeLocal& bob = frame.poses[1].nodes[0];
    EXPECT_FLOAT_EQ(bob.translation.y, ann.translation.y);
    EXPECT_FLOAT_EQ(bob.translation.z, -ann.translation.z);
  }
  const nlohmann::json seen = json_of("vestige inspect two.mcap --json -");
  EXPECT_EQ(seen["session"]["format_version"], "3");
  ASSERT_EQ(seen["people"].size(), 2U);
  EXPECT_EQ(seen["people"][1]["name"], "bob");
  EXPECT_EQ(seen["people"][1]["topic"], "/pose/2");
  EXPECT_THAT(run("vestige inspect two.mcap").standard_output, HasSubstr("'bob', faces +z"));
  EXPECT_EQ(run("vestige doctor two.mcap").exit_code, 0);
}

TEST_F(PeopleOfATrace, GetTheirCollidersInTurn) {
  record_two();
  record("", "one.mcap");
  // Ann's are a scenario's of five, Bob's one of four, turned and moved with him.
  std::size_t of_bob = 0;
  const TraceFrame first = frames_of("two.mcap").front();
  for (const ColliderSample& collider : first.colliders) of_bob += collider.id % 2;
  EXPECT_EQ(first.colliders.size(), 9U);
  EXPECT_EQ(of_bob, 4U);
  EXPECT_EQ(frames_of("one.mcap").front().colliders.size(), 9U);
  const test::Outcome none = run("vestige record --rate 60 --duration 0.1 --colliders none -o none.mcap");
  ASSERT_EQ(none.exit_code, 0) << none.standard_error;
  EXPECT_TRUE(frames_of("none.mcap").front().colliders.empty());
  EXPECT_EQ(json_of("vestige replay none.mcap --detector cpu --json -")["contacts"], 0);
  expect_failure("vestige record --colliders none --count 3 -o a.mcap", 2, {"--count", "there are no colliders"},
                 "a.mcap");
}

TEST_F(PeopleOfATrace, FlagsBelongToTheLatestAvatarAndBeforeAnyToTheFirst) {
  record("--map none --name ann --avatar builtin --avatar builtin --animation none");
  const nlohmann::json seen = json_of("vestige inspect two.mcap --json -");
  EXPECT_EQ(seen["people"][0]["name"], "ann");
  EXPECT_EQ(seen["people"][1]["name"], "builtin");
  EXPECT_FALSE(seen["session"].contains("sha256:actuator_map.png"));
  EXPECT_TRUE(seen["session"].contains("sha256:actuator_map.2.png"));
  EXPECT_NE(seen["session"]["animation"], "");
  EXPECT_EQ(seen["session"]["animation.2"], "");
  record("--avatar builtin --avatar builtin --avatar builtin", "three.mcap");
  std::vector<std::string> names;
  const nlohmann::json three = json_of("vestige inspect three.mcap --json -");
  for (const auto& person : three["people"]) names.push_back(person["name"]);
  EXPECT_THAT(names, ::testing::ElementsAre("builtin", "builtin 2", "builtin 3"));
}

TEST_F(PeopleOfATrace, ASinglePersonMayStandElsewhereInATraceOfVersionOne) {
  record("--colliders hug --at 5,0,1,90", "moved.mcap");
  EXPECT_EQ(json_of("vestige inspect moved.mcap --json -")["session"]["format_version"], "1");
  const nlohmann::json replayed = json_of("vestige replay moved.mcap --detector cpu --json -");
  EXPECT_GT(replayed["contacts"], 0);
  EXPECT_EQ(frames_of("moved.mcap").front().poses[0].origin_m, glm::dvec3(5, 0, 1));
}

TEST_F(PeopleOfATrace, WhatCannotBeMeantIsRefused) {
  const std::string record = "vestige record --duration 0.1 -o a.mcap --avatar builtin ";
  expect_failure(record + "--name ann --avatar builtin --name ann", 2, {"--name", "two people are called 'ann'"},
                 "a.mcap");
  expect_failure(record + "--name \"$(printf 'a\\377')\"", 2, {"--name", "is not UTF-8"}, "a.mcap");
  expect_failure(record + "--name \"$(printf 'a\\nb')\"", 2, {"--name", "control character"}, "a.mcap");
  expect_failure(record + "--name ''", 2, {"is empty"}, "a.mcap");
  expect_failure(record + "--map none --map none", 2, {"--map", "is given twice"}, "a.mcap");
  expect_failure(record + "--at 1,2", 2, {"--at", "'1,2' is not X,Y,Z,YAW"}, "a.mcap");
  expect_failure(record + "--at 1,2,3,left", 2, {"--at", "is not X,Y,Z,YAW"}, "a.mcap");
  expect_failure(record + "--at 1e8,0,0", 2, {"--at", "farther away than 1e7 m"}, "a.mcap");
  expect_failure(record + "--avatar builtin --live -", 2, {"--live", "person 1 has none"}, "a.mcap");
  expect_failure(record + "--at 0,0,1 --live -", 2, {"--at"}, "a.mcap");
}

TEST_F(PeopleOfATrace, WhoStandWithinEachOtherAreNamed) {
  const std::string record = "vestige record --rate 60 --duration 0.1 --avatar builtin --avatar builtin ";
  EXPECT_THAT(run(record + "-o a.mcap").standard_error,
              HasSubstr("'builtin' and 'builtin 2' stand within each other when the scene begins"));
  EXPECT_THAT(run(record + "--at 0,0,0.9,180 -o b.mcap").standard_error, Not(HasSubstr("within each other")));
}

TEST_F(PeopleOfATrace, VerbsThatKnowOnePersonSayWhoTheyMiss) {
  record_two();
  for (const char* verb : {"growth two.mcap -o a.glb"})
    expect_failure(std::string("vestige ") + verb, 1, {"two.mcap: holds 2 people"}, "a.glb");
}

TEST_F(PeopleOfATrace, AreJudgedAsTracesOfTheirOwn) {
  ASSERT_EQ(run("vestige record --colliders touch -q -o touch.mcap").exit_code, 0);
  const test::Outcome batch = run("vestige batch --traces touch.mcap --maps paper6 -o b");
  ASSERT_EQ(batch.exit_code, 0) << batch.standard_error;
  EXPECT_THAT(batch.standard_output, HasSubstr("mean over the traces of 1 file")) << "the two are not independent";
  EXPECT_THAT(batch.standard_error, Not(HasSubstr("same bytes")));
  const nlohmann::json replay = json_of("vestige replay touch.mcap --json -");
  const nlohmann::json traces = json_in("b/run.json")["traces"];
  ASSERT_EQ(traces.size(), 2U);
  for (const std::size_t person : {0U, 1U}) {
    EXPECT_EQ(traces[person]["name"], person == 0 ? "touch-1" : "touch-2");
    EXPECT_EQ(traces[person]["avatar"], person + 1);
    EXPECT_EQ(traces[person]["contacts"], replay["avatars"][person]["contacts"]);
  }
  EXPECT_GT(traces[1]["contacts"], 0);
}

TEST_F(PeopleOfATrace, AreCutJoinedAndPrinted) {
  record_two();
  ASSERT_EQ(run("vestige trim two.mcap --to 0.2 -o a.mcap").exit_code, 0);
  ASSERT_EQ(run("vestige trim two.mcap --from 0.2 -o b.mcap").exit_code, 0);
  const test::Outcome merged = run("vestige merge b.mcap a.mcap -o c.mcap");
  ASSERT_EQ(merged.exit_code, 0) << merged.standard_error;
  const std::vector<TraceFrame> before = frames_of("two.mcap");
  const std::vector<TraceFrame> after = frames_of("c.mcap");
  ASSERT_EQ(before.size(), after.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_EQ(after[i].index, before[i].index);
    EXPECT_EQ(after[i].poses[1].nodes[0].translation, before[i].poses[1].nodes[0].translation);
  }
  record("", "one.mcap");
  expect_failure("vestige merge two.mcap one.mcap -o d.mcap", 1, {"holds 1 person", "holds 2 people"}, "d.mcap");
  const std::string printed = run("vestige cat two.mcap --topic /pose/2").standard_output;
  EXPECT_EQ(std::ranges::count(printed, '\n'), 30);
  EXPECT_THAT(printed, HasSubstr("\"origin\":[0,0,0.8999"));
}

TEST_F(PeopleOfATrace, AreMendedOneByOne) {
  record_two();
  std::vector<std::byte> bytes = read_file(folder_ / "two.mcap");
  // A byte in the second person's avatar, whose attachment begins with its name.
  const std::string name = "avatar.2.glb";
  const auto* text = reinterpret_cast<const char*>(bytes.data());
  const std::size_t at = std::string_view(text, bytes.size()).rfind(name, bytes.size() / 2 + bytes.size() / 4);
  ASSERT_NE(at, std::string_view::npos);
  bytes[at + 5000] ^= std::byte{1};
  write("broken.mcap", bytes);
  const test::Outcome doctor = run("vestige doctor broken.mcap");
  EXPECT_EQ(doctor.exit_code, 3);
  EXPECT_THAT(doctor.standard_output, HasSubstr("vestige recover broken.mcap --avatar 2=builtin -o mended.mcap"));
  ASSERT_EQ(run("vestige recover broken.mcap --avatar 2=builtin -o mended.mcap").exit_code, 0);
  EXPECT_EQ(run("vestige doctor mended.mcap").exit_code, 0);
  EXPECT_EQ(frames_of("mended.mcap").size(), 30U);
  expect_failure("vestige recover broken.mcap --avatar 3=builtin -o a.mcap", 1, {"holds no person 3"}, "a.mcap");
  expect_failure("vestige recover broken.mcap --avatar 0=builtin -o a.mcap", 2, {"names no person"}, "a.mcap");
  expect_failure("vestige recover broken.mcap --avatar builtin --avatar 1=builtin -o a.mcap", 2,
                 {"is given twice for person 1"}, "a.mcap");

  bytes = read_file(folder_ / "two.mcap");
  bytes.resize(bytes.size() - 3000);
  write("cut.mcap", bytes);
  EXPECT_NE(run("vestige recover cut.mcap -o whole.mcap").exit_code, 1);
  for (const TraceFrame& frame : frames_of("whole.mcap"))
    EXPECT_EQ(frame.poses[1].nodes.size(), frame.poses[0].nodes.size());
}

}  // namespace
}  // namespace vestige
