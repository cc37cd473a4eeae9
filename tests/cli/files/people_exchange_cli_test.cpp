// Several people leave a trace for other programs, and come back.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "tests/cli/files/exchange_fixture.hpp"
#include "traces/gltf/avatar_gltf.hpp"
#include "traces/trace_file/trace_reader.hpp"

namespace vestige {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Two people with maps and names of their own, limbs that belong to them, and colliders of nobody's.
class PeopleExchange : public test::ExchangeTest {
 protected:
  void SetUp() override {
    ASSERT_EQ(run("vestige record --avatar builtin --name Ann --limbs hand_left,hand_right --avatar builtin --name Bob "
                  "--map torso16 --at 0.2,0,0.6,170 --colliders rain --count 20 --rate 100 --duration 0.6 "
                  "--origin 5,0,-3 -q -o a.mcap")
                  .exit_code,
              0);
  }
  void expect_same(const std::string& back) const {
    EXPECT_EQ(run("vestige cat a.mcap > a.txt; vestige cat " + back + " > back.txt; cmp a.txt back.txt").exit_code, 0)
        << back;
    EXPECT_EQ(hash_of(back), hash_of("a.mcap"));
    const TraceReader before(folder_ / "a.mcap", People::kSeveral);
    const TraceReader after(folder_ / back, People::kSeveral);
    ASSERT_EQ(after.people().size(), 2U);
    for (const std::size_t person : {0U, 1U}) {
      EXPECT_EQ(after.people()[person].name, before.people()[person].name);
      EXPECT_EQ(after.people()[person].facing, before.people()[person].facing);
      EXPECT_TRUE(
          std::ranges::equal(after.people()[person].actuator_map_png, before.people()[person].actuator_map_png));
    }
  }
};

TEST_F(PeopleExchange, ThroughAFolderOfCsvIsTheSameTraceToTheBit) {
  const test::Outcome exported = run("vestige export a.mcap -o tables");
  ASSERT_EQ(exported.exit_code, 0) << exported.standard_error;
  EXPECT_THAT(exported.standard_output, HasSubstr("2 people"));
  EXPECT_EQ(run("ls tables | tr '\\n' ' '").standard_output,
            "actuator_map.2.json actuator_map.2.png actuator_map.json actuator_map.png avatar.2.glb avatar.glb "
            "colliders.csv poses.2.csv poses.csv session.json ");
  EXPECT_EQ(run("head -1 tables/colliders.csv").standard_output, "frame,time_s,id,x,y,z,radius_m,owner,teleported\n");
  const test::Outcome imported = run("vestige import tables -o back.mcap");
  ASSERT_EQ(imported.exit_code, 0) << imported.standard_error;
  expect_same("back.mcap");

  // One person's export into the same folder takes the other's files away.
  ASSERT_EQ(run("vestige record --rate 100 --duration 0.1 -q -o one.mcap && vestige export one.mcap -o tables --force")
                .exit_code,
            0);
  EXPECT_FALSE(exists("tables/poses.2.csv"));
  EXPECT_FALSE(exists("tables/avatar.2.glb"));
  // Also what stands behind a gap.
  ASSERT_EQ(run("vestige export a.mcap -o tables --force && rm tables/poses.2.csv && cp tables/avatar.glb "
                "tables/avatar.4.glb && vestige export one.mcap -o tables --force")
                .exit_code,
            0);
  EXPECT_EQ(run("ls tables | grep -c '[.][24][.]'").standard_output, "0\n");
}

TEST_F(PeopleExchange, NodesWithoutPosesAreToldOfEach) {
  ASSERT_EQ(run("vestige export a.mcap -o tables -q").exit_code, 0);
  ASSERT_EQ(run("cut -d, -f1-15 tables/poses.2.csv > p && mv p tables/poses.2.csv").exit_code, 0);
  EXPECT_THAT(run("vestige import tables -o back.mcap").standard_error,
              HasSubstr("poses.2.csv: these nodes of the avatar keep their rest pose"));
}

TEST_F(PeopleExchange, ThroughHdf5IsTheSameTraceToTheBitAndTakesContactsAlong) {
  ASSERT_EQ(run("vestige replay a.mcap --contacts a.csv -q").exit_code, 0);
  const nlohmann::json json = json_of("vestige export a.mcap -o a.h5 --contacts a.csv --json -");
  EXPECT_GT(json["contacts"], 0);
  EXPECT_EQ(run("vestige explain a.h5").exit_code, 0);
  ASSERT_EQ(run("vestige import a.h5 -o back.mcap").exit_code, 0);
  expect_same("back.mcap");
  ASSERT_EQ(run("awk -F, -v OFS=, 'NR == 2 {$NF = 3} {print}' a.csv > b.csv").exit_code, 0);
  expect_failure("vestige export a.mcap -o b.h5 --contacts b.csv", 1, {"b.csv, line 2", "avatar"}, "b.h5");
  // Without the column, nobody knows whom they touch.
  ASSERT_EQ(run("sed 's/,[^,]*$//' a.csv > c.csv").exit_code, 0);
  expect_failure("vestige export a.mcap -o c.h5 --contacts c.csv", 1, {"c.csv", "do not say whom of the 2 people"},
                 "c.h5");
  ASSERT_EQ(
      run("vestige record --rate 100 --duration 0.2 -q -o one.mcap && vestige replay one.mcap --contacts one.h5 -q")
          .exit_code,
      0);
  expect_failure("vestige plot body a.mcap --person 1 --contacts one.h5 -o body", 1,
                 {"one.h5", "do not say whom of the 2 people"}, "body.png");
}

/// Joints of the file stand where the trace has them, of both people, in every frame.
TEST_F(PeopleExchange, AGlbShowsBothWhereTheyAre) {
  ASSERT_EQ(run("vestige export a.mcap -o a.glb").exit_code, 0);
  const Avatar both = parse_avatar_glb(read_file(folder_ / "a.glb"), "a.glb");
  TraceReader trace(folder_ / "a.mcap", People::kSeveral);
  const Avatar one = parse_avatar_glb(trace.people()[1].avatar_glb, "avatar.2.glb");
  const nlohmann::json json = json_of_glb("a.glb");
  ASSERT_EQ(json["skins"].size(), 2U);
  std::vector<std::size_t> origin_of;
  for (const char* name : {"Ann", "Bob"})
    origin_of.push_back(static_cast<std::size_t>(
        std::ranges::find(both.nodes, std::string(name), [](const Node& node) { return std::string(node.name); }) -
        both.nodes.begin()));
  const std::size_t count = one.nodes.size();
  ASSERT_LT(std::max(origin_of[0], origin_of[1]), both.nodes.size());
  std::vector<glm::dmat4> shown;
  std::vector<glm::dmat4> expected;
  TraceFrame frame;
  glm::dvec3 base_m(0);
  for (std::uint64_t number = 0; trace.next(frame); ++number) {
    if (number == 0) base_m = frame.poses[0].origin_m;
    // Keys are at times of fp32.
    world_matrices(both, sample_animation(both, both.animations.front(), double{static_cast<float>(frame.time_s())}),
                   shown);
    for (const std::size_t person : {0U, 1U}) {
      world_matrices(one, frame.poses[person], expected);
      // The second person's nodes follow those of the first, in their order.
      const auto first = json["skins"][person]["joints"].get<std::vector<std::size_t>>();
      const std::size_t offset = person == 0 ? 0 : first.front() - json["skins"][0]["joints"][0].get<std::size_t>();
      for (std::size_t i = 0; i < count; ++i) {
        const glm::dvec3 there = glm::dvec3(expected[i][3]) + frame.poses[person].origin_m - base_m;
        if (!json["nodes"][offset + i].contains("mesh")) {
          EXPECT_LT(glm::distance(glm::dvec3(shown[offset + i][3]), there), 1e-5)
              << number << ' ' << person << ' ' << i;
        }
      }
    }
  }
}

TEST_F(PeopleExchange, PosesAloneAreATableForEach) {
  EXPECT_EQ(json_of("vestige export a.mcap -o p.csv --what poses --json -")["outputs"],
            nlohmann::json({"p.csv", "p.2.csv"}));
  EXPECT_EQ(run("wc -l < p.2.csv").standard_output, "61\n");
  EXPECT_NE(run("cmp p.csv p.2.csv").exit_code, 0);
  ASSERT_EQ(run("touch p.3.csv").exit_code, 0);
  EXPECT_THAT(run("vestige export a.mcap -o p.csv --what poses --force").standard_error,
              HasSubstr("p.3.csv: is not of this trace"));
  expect_failure("vestige export a.mcap -o q.csv --what poses --json q.2.csv", 2, {"q.2.csv"}, "q.csv");
  expect_failure("vestige export a.mcap -o - --format csv --what poses", 2, {"each of 2 people"}, "-");
}

TEST_F(PeopleExchange, LinesHoldThePosesOfAll) {
  const std::string line = run("vestige export a.mcap -o - --format ndjson | head -1").standard_output;
  const nlohmann::json json = nlohmann::json::parse(line);
  EXPECT_NE(json["pose"]["nodes"], json["pose.2"]["nodes"]);
  EXPECT_EQ(json["pose.2"]["nodes"].size(), json["pose"]["nodes"].size());
  // Nobody is left out without a word, and no limb loses its owner.
  expect_failure("vestige export a.mcap -o - --format ndjson -q | vestige record --live - -o back.mcap", 1,
                 {"line 1: has 'pose.2'", "vestige import"}, "back.mcap");
  expect_failure(
      "vestige export a.mcap -o - --format ndjson -q | sed 's/\"pose.2\":.*,\"coll/\"coll/' | vestige record "
      "--live - -o back.mcap",
      1, {"line 1: has a collider with an owner"}, "back.mcap");
  expect_failure("vestige export a.mcap -o a.pvd", 2, {"one person", "vestige plot paraview a.mcap --person 1"},
                 "a.pvd");
}

TEST_F(PeopleExchange, WhatDoesNotFitTogetherIsRefused) {
  const auto refuses = [&](const std::string& change, const std::vector<std::string>& words) {
    ASSERT_EQ(run("rm -rf tables && vestige export a.mcap -o tables -q && " + change).exit_code, 0);
    expect_failure("vestige import tables -o b.mcap", 1, words, "b.mcap");
  };
  refuses("rm tables/avatar.2.glb", {"files of person 2, but no avatar.2.glb"});
  refuses("rm tables/poses.2.csv", {"files of person 2, but no poses.2.csv"});
  refuses("for f in tables/*.2.*; do mv $f $(echo $f | sed s/2/3/); done", {"files of person 3, but no poses.2.csv"});
  refuses("sed -i '$d' tables/poses.2.csv", {"poses.2.csv", "has no pose in frame 59"});
  refuses("sed -i '$d' tables/poses.csv", {"poses.2.csv", "has frame 59, which the first person does not have"});
  refuses("sed -i '5d' tables/poses.2.csv", {"poses.2.csv", "has frame 4 at 0.04 s", "frame 3 at 0.03 s"});
  refuses("awk -F, -v OFS=, 'NR == 9 {$8 = 3} {print}' tables/colliders.csv > c && mv c tables/colliders.csv",
          {"colliders.csv, line 9", "person 3"});
  refuses("echo '{\"name.2\": 7}' > tables/session.json", {"session.json", "a text 'name.2'"});
  refuses("echo '{\"name.2\": \"a\\u0000b\"}' > tables/session.json",
          {"session.json", "'name.2' has a control character"});
  refuses("echo '{\"name\": \"x\", \"name.2\": \"x\"}' > tables/session.json",
          {"session.json", "two people are called 'x'"});
  refuses("echo '{\"facing.2\": \"up\"}' > tables/session.json", {"session.json", "'facing.2' is 'up'"});
  expect_failure("vestige import tables --facing +x -o b.mcap", 1, {"session.json"}, "b.mcap");
}

TEST_F(PeopleExchange, CollidersOfAFileMayBelongToPeople) {
  ASSERT_EQ(run("vestige export a.mcap -o c.csv --what colliders -q").exit_code, 0);
  const std::string people =
      "vestige record --avatar builtin --avatar builtin --at 0,0,0.6,180 --rate 100 --duration 0.5 ";
  const test::Outcome recorded = run(people + "--colliders c.csv -q -o d.mcap");
  ASSERT_EQ(recorded.exit_code, 0) << recorded.standard_error;
  TraceReader trace(folder_ / "d.mcap", People::kSeveral);
  TraceFrame frame;
  ASSERT_TRUE(trace.next(frame));
  EXPECT_GT(std::ranges::count(frame.colliders, 1, &ColliderSample::owner), 2);
  EXPECT_GT(std::ranges::count(frame.colliders, 0, &ColliderSample::owner), 2);
  write("e.csv", "time_s,id,x,y,z,owner\n0,1,0,0,0,1\n1,1,0,0,0,2\n");
  expect_failure(people + "--colliders e.csv -o e.mcap", 1,
                 {"e.csv, line 3", "collider 1 belongs to person 2, and before it belonged to person 1"}, "e.mcap");
  write("f.csv", "time_s,id,x,y,z,owner\n0,1,0,0,0,3\n1,1,0,0,0,3\n");
  expect_failure(people + "--colliders f.csv -o f.mcap", 1,
                 {"f.csv, line 2", "collider 1 belongs to person 3", "are only 2"}, "f.mcap");
  write("g.csv", "time_s,id,x,y,z,owner\n0,1,0,0,0,-1\n");
  expect_failure(people + "--colliders g.csv -o g.mcap", 1, {"g.csv, line 2", "owner is not a whole number"}, "g.mcap");
}

}  // namespace
}  // namespace vestige
