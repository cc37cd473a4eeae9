// What viewers draw, decoded by Foxglove's own schemas.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "tests/support/builtin_avatar.hpp"
#include "tests/support/npm.hpp"
#include "tests/support/test_data.hpp"
#include "tests/traces/trace_file/trace_fixture.hpp"
#include "tests/traces/viz/viz_json.hpp"
#include "traces/trace_file/trace_reader.hpp"
#include "traces/viz/viz_builder.hpp"
#include "traces/viz/viz_pace.hpp"

namespace vestige {
namespace {

using nlohmann::json;
using test::matrix_of;
using test::vector_of;
using ::testing::Contains;
using ::testing::IsEmpty;
using ::testing::IsSupersetOf;
using ::testing::Not;
using ::testing::UnorderedElementsAre;

class VizTest : public ::testing::Test {
 protected:
  void SetUp() override { VESTIGE_REQUIRE_DATA(test::npm_package("@foxglove/schemas")); }

  TraceFrame frame(std::uint64_t index) const {
    TraceFrame frame;
    frame.index = index;
    frame.time_ns = static_cast<std::int64_t>(index) * 1'000'000;
    frame.poses.front() = looped_pose(avatar_, &avatar_.animations.front(), static_cast<double>(index) / 1000);
    frame.poses.front().origin_m = {10, 0, -5};
    frame.poses.front().nodes[1].scale = glm::vec3(1.5F);  // whoever is scaled carries those below away from it
    for (std::uint32_t id = 0; id < 3; ++id)
      if (index < 50 || id != 1) frame.colliders.push_back({id + 7, {id, 1.5, static_cast<double>(index)}});
    return frame;
  }

  json record(std::uint64_t frames) const {
    TraceWriterOptions options = test::steady_options(100'000);
    options.viz = Viz::kScene;
    TraceWriter writer(folder_ / "a.mcap", {}, {{avatar_, {.avatar_glb = builtin_avatar_glb()}}}, options);
    for (std::uint64_t i = 0; i < frames; ++i) writer.write(frame(i));
    writer.finish();
    return json::parse(test::run_node("read_viz.mjs", folder_ / "a.mcap"));
  }

  const test::TemporaryFolder folder_;
  const Avatar avatar_ = test::builtin_avatar();
};

TEST_F(VizTest, TransformsPutEveryNodeWhereTheReferenceSkinningDoes) {
  const json seen = record(200);
  const json& tf = seen["/viz/tf"];
  EXPECT_EQ(tf["schema"], "foxglove.FrameTransforms");
  EXPECT_EQ(tf["messages"].size(), 12U) << "sixty a second, of 0.2 s";
  for (const json& message : tf["messages"]) {
    const auto index = message["log_time"].get<std::uint64_t>() / 1'000'000;
    std::vector<glm::dmat4> expected;
    const TraceFrame as_recorded = frame(index);
    world_matrices(avatar_, as_recorded.poses.front(), expected);
    std::map<std::string, glm::dmat4> world = {{"world", glm::dmat4(1)}};
    for (const json& transform : message["transforms"]) {
      EXPECT_EQ(transform["timestamp"]["nsec"], index * 1'000'000);
      const auto parent = world.find(transform["parent_frame_id"].get<std::string>());
      ASSERT_NE(parent, world.end()) << transform << " comes before its parent";
      EXPECT_TRUE(
          world.emplace(transform["child_frame_id"].get<std::string>(), parent->second * matrix_of(transform)).second);
    }
    EXPECT_EQ(world.size(), avatar_.nodes.size() + 3);
    for (std::size_t i = 0; i < avatar_.nodes.size(); ++i) {
      const glm::dvec3 place = as_recorded.poses.front().origin_m + glm::dvec3(expected[i][3]);
      EXPECT_LT(glm::length(glm::dvec3(world.at(avatar_.nodes[i].name)[3]) - place), 1e-6) << avatar_.nodes[i].name;
    }
    const glm::dmat4& upright = world.at("upright");
    const std::string& root = avatar_.nodes[static_cast<std::size_t>(avatar_.root_node)].name;
    EXPECT_LT(glm::length(glm::dvec3(upright[3] - world.at(root)[3])), 1e-6);
    EXPECT_LT(glm::length(glm::dvec3(upright[2]) - glm::dvec3(0, 1, 0)), 1e-6) << "viewers have z up";
  }
}

TEST_F(VizTest, FramesAndSkeletonOfASecondPersonHaveTheirNumber) {
  TraceWriterOptions options = test::steady_options();
  options.viz = Viz::kScene;
  const TracePerson person = {avatar_, {.avatar_glb = builtin_avatar_glb()}};
  TraceWriter writer(folder_ / "a.mcap", {}, {person, person}, options);
  TraceFrame two = frame(0);
  two.poses.push_back(two.poses.front());
  two.poses[1].origin_m = {0, 0, 7};
  writer.write(two);
  writer.finish();
  const json seen = json::parse(test::run_node("read_viz.mjs", folder_ / "a.mcap"));
  std::map<std::string, json> frames;
  for (const json& transform : seen["/viz/tf"]["messages"][0]["transforms"])
    EXPECT_TRUE(frames.emplace(transform["child_frame_id"].get<std::string>(), transform).second) << transform;
  EXPECT_EQ(frames.size(), 2 * (avatar_.nodes.size() + 1) + 1);
  EXPECT_EQ(frames.at("avatar 2")["translation"]["z"], 7);
  const std::string root = avatar_.nodes[static_cast<std::size_t>(avatar_.node_order.front())].name;
  EXPECT_EQ(frames.at(root)["parent_frame_id"], "avatar");
  EXPECT_EQ(frames.at("2/" + root)["parent_frame_id"], "avatar 2");
  std::vector<std::string> entities;
  for (const json& entity : seen["/viz/scene"]["messages"][0]["entities"]) entities.push_back(entity["id"]);
  EXPECT_THAT(entities, IsSupersetOf({"skeleton", "skeleton 2"}));
}

TEST_F(VizTest, TheSceneHasASphereForEveryColliderAndLinesForTheSkeleton) {
  const json seen = record(100);
  const json& scene = seen["/viz/scene"];
  EXPECT_EQ(scene["schema"], "foxglove.SceneUpdate");
  ASSERT_EQ(scene["messages"].size(), 6U);
  std::size_t deletions = 0;
  for (const json& message : scene["messages"]) {
    const auto index = message["log_time"].get<std::uint64_t>() / 1'000'000;
    const TraceFrame as_recorded = frame(index);
    std::map<std::string, json> entities;
    for (const json& entity : message["entities"]) {
      entities[entity["id"].get<std::string>()] = entity;
      EXPECT_EQ(entity["timestamp"]["nsec"], index * 1'000'000);
    }
    EXPECT_EQ(entities.size(), as_recorded.colliders.size() + 1);
    for (const ColliderSample& collider : as_recorded.colliders) {
      const json& entity = entities[fmt::format("collider {}", collider.id)];
      EXPECT_EQ(entity["frame_id"], "world");
      ASSERT_EQ(entity["spheres"].size(), 1U);
      EXPECT_EQ(vector_of(entity["spheres"][0]["pose"]["position"]), collider.position_m);
      EXPECT_EQ(entity["spheres"][0]["pose"]["orientation"]["w"], 1.0);
      EXPECT_EQ(entity["spheres"][0]["color"]["a"], 1.0);
      EXPECT_GT(entity["spheres"][0]["size"]["x"], 0.001);
    }
    const json& skeleton = entities["skeleton"];
    EXPECT_EQ(skeleton["frame_id"], "avatar");
    EXPECT_EQ(skeleton["lines"][0]["type"], 2) << "LINE_LIST";
    std::size_t bones = 0;
    for (const Node& node : avatar_.nodes) bones += node.parent >= 0 ? 1U : 0U;
    EXPECT_EQ(skeleton["lines"][0]["points"].size(), 2 * bones);
    for (const json& deletion : message["deletions"]) {
      ++deletions;
      EXPECT_EQ(deletion["id"], "collider 8");
    }
  }
  EXPECT_EQ(deletions, 1U) << "collider 8 leaves once";
}

/// The ids of a message's entities or deletions, or its frames.
std::vector<std::string> names_of(const json& list, const char* key) {
  std::vector<std::string> names;
  for (const json& one : list) names.push_back(one[key]);
  return names;
}

TEST_F(VizTest, WhatHasNoPlaceIsTakenAway) {
  constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();
  TraceWriterOptions options = test::steady_options();
  options.viz = Viz::kScene;
  const TracePerson person = {avatar_, {.avatar_glb = builtin_avatar_glb()}};
  TraceWriter writer(folder_ / "a.mcap", {}, {person, person}, options);
  for (std::uint64_t i = 0; i < 3; ++i) {
    TraceFrame two = frame(i * 20);
    two.poses.push_back(two.poses.front());
    if (i == 0) two.poses[0].origin_m.y = kNowhere;
    if (i == 2) two.poses[1].nodes.back().translation.x = std::numeric_limits<float>::infinity();
    if (i == 2) two.colliders[0].position_m.z = kNowhere;
    writer.write(two);
  }
  writer.finish();
  const json seen = json::parse(test::run_node("read_viz.mjs", folder_ / "a.mcap"));
  const json& scenes = seen["/viz/scene"]["messages"];
  ASSERT_EQ(scenes.size(), 3U);
  EXPECT_THAT(names_of(scenes[0]["entities"], "id"),
              UnorderedElementsAre("skeleton 2", "collider 7", "collider 8", "collider 9"));
  EXPECT_THAT(scenes[0]["deletions"], IsEmpty());
  EXPECT_THAT(names_of(scenes[1]["entities"], "id"), IsSupersetOf({"skeleton", "skeleton 2"}));
  EXPECT_THAT(scenes[1]["deletions"], IsEmpty());
  EXPECT_THAT(names_of(scenes[2]["entities"], "id"), UnorderedElementsAre("skeleton", "collider 8", "collider 9"));
  EXPECT_THAT(names_of(scenes[2]["deletions"], "id"), UnorderedElementsAre("skeleton 2", "collider 7"));
  const json& frames = seen["/viz/tf"]["messages"];
  for (std::size_t i = 0; i < 2; ++i)
    for (const json& transform : frames[i]["transforms"]) {
      const std::string parent = transform["parent_frame_id"];
      EXPECT_TRUE(transform["child_frame_id"] != "upright" || parent == "avatar 2") << parent;
    }
  EXPECT_THAT(names_of(frames[0]["transforms"], "child_frame_id"), Contains("upright"));
  EXPECT_THAT(names_of(frames[1]["transforms"], "child_frame_id"), IsSupersetOf({"avatar", "upright"}));
  EXPECT_THAT(names_of(frames[2]["transforms"], "child_frame_id"), Not(Contains("upright"))) << "it does not jump";
}

TEST(VizPaceTest, KnowsNoOverflow) {
  constexpr std::int64_t kLast_ns = std::numeric_limits<std::int64_t>::max();
  VizPace rare(1e-11);
  EXPECT_TRUE(rare.is_due(0));
  rare.end_slot(0);
  EXPECT_FALSE(rare.is_due(kLast_ns - 1));
  VizPace late(60);
  late.end_slot(kLast_ns);
  EXPECT_FALSE(late.is_due(kLast_ns - 1));
}

TEST(VizBuilderTest, TimesEndWithTheLastSecondOf32Bits) {
  EXPECT_EQ(VizBuilder::time(1'500'000'000).sec(), 1U);
  EXPECT_EQ(VizBuilder::time(1'500'000'000).nsec(), 500'000'000U);
  const foxglove::Time last = VizBuilder::time(std::numeric_limits<std::int64_t>::max());
  EXPECT_EQ(last.sec(), std::numeric_limits<std::uint32_t>::max());
  EXPECT_EQ(last.nsec(), 0U);
}

TEST_F(VizTest, ReadersOfTracesPassItOver) {
  record(60);
  TraceReader reader(folder_ / "a.mcap");
  const auto frames = test::read_frames(reader);
  ASSERT_EQ(frames.size(), 60U);
  for (const TraceFrame& read : frames) EXPECT_TRUE(test::same_bits(read, frame(read.index)));
  EXPECT_TRUE(reader.complete());
}

}  // namespace
}  // namespace vestige
