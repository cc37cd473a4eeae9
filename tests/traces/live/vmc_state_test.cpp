// Live input by the VMC protocol.

#include "traces/live/vmc_state.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/builtin_avatar.hpp"
#include "tests/support/made/edited_glb.hpp"
#include "tests/support/osc.hpp"
#include "tests/traces/trace_file/trace_fixture.hpp"
#include "traces/base/error.hpp"
#include "traces/body/humanoid.hpp"
#include "traces/gltf/avatar_gltf.hpp"
#include "traces/mcap/decode.hpp"
#include "traces/scene/builtin_avatar.hpp"

namespace vestige {
namespace {

using test::bone;
using test::bundle;
using test::bytes_of;
using test::collider;
using test::OscBuilder;
using test::placement;
using test::with_id;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class Vmc : public ::testing::Test {
 protected:
  /// World positions of nodes in the state's pose, without the origin.
  std::vector<glm::dvec3> joints(VmcState& state) const {
    TraceFrame frame;
    state.show(frame);
    std::vector<glm::dmat4> world;
    world_matrices(avatar_, frame.poses.front(), world);
    std::vector<glm::dvec3> positions;
    for (const glm::dmat4& matrix : world) positions.emplace_back(matrix[3]);
    return positions;
  }
  std::size_t node(const char* name) const { return avatar_.humanoid.node_of.find(name)->second; }

  const Avatar avatar_ = test::builtin_avatar();
};

glm::dquat about(const glm::dvec3& axis, double degrees) {
  return glm::angleAxis(degrees * std::numbers::pi / 180, axis);
}

void expect_near(const glm::dvec3& a, const glm::dvec3& b, double tolerance = 1e-6) {
  EXPECT_LT(glm::length(a - b), tolerance)
      << fmt::format("({}, {}, {}) is not ({}, {}, {})", a.x, a.y, a.z, b.x, b.y, b.z);
}

TEST_F(Vmc, ASenderInItsRestPoseLeavesTheAvatarInItsOwn) {
  VmcState state(avatar_, glm::dvec3(5, 6, 7));
  std::vector<std::vector<std::byte>> all = {placement("/VMC/Ext/Root/Pos", "root", {}, {1, 0, 0, 0})};
  for (const auto& [name, index] : avatar_.humanoid.node_of)
    if (name != "Hips") all.push_back(bone(name.c_str(), {1, 0, 0, 0}, {9, 9, 9}));
  EXPECT_TRUE(state.take(bundle(all)));
  TraceFrame frame;
  state.show(frame);
  EXPECT_EQ(frame.poses.front().origin_m, glm::dvec3(5, 6, 7));
  const Pose rest = rest_pose(avatar_);
  for (std::size_t i = 0; i < rest.nodes.size(); ++i) {
    expect_near(frame.poses.front().nodes[i].translation, rest.nodes[i].translation);
    EXPECT_NEAR(
        std::abs(glm::dot(glm::dquat(frame.poses.front().nodes[i].rotation), glm::dquat(rest.nodes[i].rotation))), 1,
        1e-6);
  }
  EXPECT_EQ(state.bones().size(), 20U);
}

/// In Unity a left arm points to -X. Turned by +90 degrees about +Z there, which in left-handed axes is clockwise seen
/// from the front of the axis, it points to -Y: down.
TEST_F(Vmc, ALeftArmThatGoesDownInUnityGoesDownHere) {
  VmcState state(avatar_, glm::dvec3(0));
  const auto before = joints(state);
  state.take(bone("LeftUpperArm", about({0, 0, 1}, 90)));
  const auto after = joints(state);
  const glm::dvec3 arm_before = before[node("LeftLowerArm")] - before[node("LeftUpperArm")];
  const glm::dvec3 arm_after = after[node("LeftLowerArm")] - after[node("LeftUpperArm")];
  EXPECT_GT(arm_before.x, 0) << "an avatar that looks along +Z has its left at +X";
  expect_near(arm_after, {arm_before.y, -arm_before.x, arm_before.z});
  // The right arm and the legs are where they were.
  expect_near(after[node("RightHand")], before[node("RightHand")]);
}

TEST_F(Vmc, AHeadThatTurnsToItsLeftInUnityTurnsToItsLeftHere) {
  VmcState state(avatar_, glm::dvec3(0));
  // Left is -X in Unity and +X here: looking along +Z, it turns by -90 degrees about Unity's +Y.
  state.take(bone("Head", about({0, 1, 0}, -90)));
  TraceFrame frame;
  state.show(frame);
  std::vector<glm::dmat4> rest;
  std::vector<glm::dmat4> world;
  world_matrices(avatar_, rest_pose(avatar_), rest);
  world_matrices(avatar_, frame.poses.front(), world);
  const glm::dmat4 turn = world[node("Head")] * glm::inverse(rest[node("Head")]);
  expect_near(glm::dvec3(turn * glm::dvec4(0, 0, 1, 0)), {1, 0, 0});
}

TEST_F(Vmc, RootAndHipsMoveTheWholeBody) {
  VmcState state(avatar_, glm::dvec3(0));
  const auto before = joints(state);
  const glm::dvec3 hips = before[node("Hips")];
  // The hips stay where they are in the sender's model; the model stands 2 m to Unity's right and looks to its right.
  state.take(bundle({bone("Hips", {1, 0, 0, 0}, {-hips.x, hips.y, hips.z}),
                     placement("/VMC/Ext/Root/Pos", "root", {2, 0, 0}, about({0, 1, 0}, 90))}));
  const auto after = joints(state);
  for (const char* name : {"Hips", "Head", "LeftHand", "RightToes"}) {
    const glm::dvec3 p = before[node(name)];
    // Here that is 2 m to -X, looking to -X: forward (+Z) has become -X, and left (+X) +Z.
    expect_near(after[node(name)], {-2 - p.z, p.y, p.x});
  }
}

/// 1 m to its right, 3 m forward, as the avatar faces; Unity's right is +X, and its forward +Z.
TEST_F(Vmc, AnAvatarMovesTheWayItFaces) {
  const std::map<Facing, glm::dvec3> moved = {{Facing::kPlusZ, {-1, 2, 3}},
                                              {Facing::kPlusX, {3, 2, 1}},
                                              {Facing::kMinusZ, {1, 2, -3}},
                                              {Facing::kMinusX, {-3, 2, -1}}};
  for (const auto& [facing, expected] : moved) {
    Avatar avatar = avatar_;
    avatar.facing.axis = facing;
    VmcState state(avatar, glm::dvec3(0));
    const auto before = joints(state);
    state.take(placement("/VMC/Ext/Root/Pos", "root", {1, 2, 3}, {1, 0, 0, 0}));
    const auto after = joints(state);
    expect_near(after[node("Head")] - before[node("Head")], expected);
  }
}

/// A node whose own rest frame is turned: what is sent is meant in a skeleton without such turns.
TEST(VmcState, RefusesAnAvatarThatDoesNotStand) {
  const Avatar laid = parse_avatar_glb(test::laid_glb(builtin_avatar_glb(), 90, {1, 0, 0}), "laid.glb");
  try {
    const VmcState state(laid, {});
    ADD_FAILURE() << "taken";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("--avatar: the avatar does not stand"));
  }
}

TEST_F(Vmc, RotationsAreTurnedIntoEachNodesOwnFrame) {
  Avatar avatar = test::skeleton(2);
  avatar.nodes[0].rest.rotation = glm::quat(about({0, 0, 1}, 90));
  avatar.nodes[1].rest.translation = glm::vec3(0, -1, 0);  // to +X, in the avatar's frame
  avatar.nodes[1].rest.rotation = glm::quat(about({1, 0, 0}, 30));
  avatar.humanoid.node_of = {{"Hips", 0}, {"Spine", 1}};
  VmcState state(avatar, glm::dvec3(0));
  state.take(bone("Spine", about({0, 1, 0}, -90)));  // here +90 degrees about +Y
  TraceFrame frame;
  state.show(frame);
  std::vector<glm::dmat4> rest;
  std::vector<glm::dmat4> world;
  world_matrices(avatar, rest_pose(avatar), rest);
  world_matrices(avatar, frame.poses.front(), world);
  const glm::dmat4 turn = world[1] * glm::inverse(rest[1]);
  expect_near(glm::dvec3(turn * glm::dvec4(0, 0, 1, 0)), {1, 0, 0});
  expect_near(glm::dvec3(turn * glm::dvec4(0, 1, 0, 0)), {0, 1, 0});
}

TEST_F(Vmc, CollidersComeGoAndJump) {
  VmcState state(avatar_, glm::dvec3(0));
  state.take(bundle({collider(7, 1, 2, 3), collider(2, 4, 5, 6), with_id("/vestige/teleport", 7)}));
  TraceFrame frame;
  state.show(frame);
  ASSERT_EQ(frame.colliders.size(), 2U);
  EXPECT_EQ(frame.colliders[1].id, 7U);
  EXPECT_EQ(frame.colliders[1].position_m, glm::dvec3(1, 2, 3)) << "glTF's axes, as they are";
  EXPECT_THAT(frame.teleported, ElementsAre(7U));
  state.take(with_id("/vestige/collider/remove", 2));
  state.show(frame);
  ASSERT_EQ(frame.colliders.size(), 1U);
  EXPECT_TRUE(frame.teleported.empty());
}

TEST_F(Vmc, ACollidersRadiusIsThatOfItsLastMessage) {
  VmcState state(avatar_, glm::dvec3(0));
  const auto radius = [&] {
    TraceFrame frame;
    state.show(frame);
    return frame.colliders.at(0).radius_m;
  };
  state.take(collider(1, 1, 2, 3, 0.05F));
  EXPECT_EQ(radius(), 0.05F);
  OscBuilder twice(lo_message_new());
  lo_message_add_int32(twice.get(), 1);
  for (const double value : {1.0, 2.0, 3.0, 0.1}) lo_message_add_double(twice.get(), value);
  state.take(bytes_of("/vestige/collider", twice));
  EXPECT_EQ(radius(), 0.1F);
  for (const float wrong : {-1.0F, 11.0F, NAN}) state.take(collider(1, 1, 2, 3, wrong));
  EXPECT_EQ(state.malformed(), 3U);
  EXPECT_EQ(radius(), 0.1F);
  state.take(collider(1, 1, 2, 3));
  EXPECT_EQ(radius(), 0.0F) << "a message without a radius is that of a point";
}

TEST_F(Vmc, CollidersStandWhereTheAvatarDoes) {
  VmcState state(avatar_, glm::dvec3(5, 6, 7));
  state.take(collider(1, 1, 2, 3));
  TraceFrame frame;
  state.show(frame);
  EXPECT_EQ(frame.poses.front().origin_m, glm::dvec3(5, 6, 7));
  ASSERT_EQ(frame.colliders.size(), 1U);
  EXPECT_EQ(frame.colliders[0].position_m, glm::dvec3(6, 8, 10));
}

TEST_F(Vmc, AMalformedDatagramChangesNothingAndIsCounted) {
  VmcState state(avatar_, glm::dvec3(0));
  const auto before = joints(state);
  OscBuilder text(lo_message_new());
  lo_message_add_string(text.get(), "LeftUpperArm");
  const std::vector<std::vector<std::byte>> wrong = {
      {},
      std::vector<std::byte>(3, std::byte{'x'}),
      bundle({collider(1, 0, 0, 0), bytes_of("/VMC/Ext/Bone/Pos", text)}),
      bundle({collider(1, 0, 0, 0), bone("LeftUpperArm", {0, 0, 0, 0})}),
      bundle({collider(1, 0, 0, 0), bone("LeftUpperArm", {1, 0, 0, 0}, {INFINITY, 0, 0})}),
      bundle({collider(1, 0, 0, 0), collider(-1, 0, 0, 0)}),
      bundle({collider(1, 0, 0, 0), collider(2, NAN, 0, 0)}),
      bundle({collider(1, 0, 0, 0), bone("Hips", {1, 0, 0, 0}, {1e38, 0, 0})}),
  };
  for (const auto& datagram : wrong) EXPECT_FALSE(state.take(datagram));
  EXPECT_EQ(state.malformed(), wrong.size());
  EXPECT_EQ(state.problems().size(), wrong.size());
  EXPECT_EQ(joints(state), before);
  TraceFrame frame;
  state.show(frame);
  EXPECT_TRUE(frame.colliders.empty());
  EXPECT_FALSE(state.take(with_id("/somebody/else", 1))) << "other addresses are nobody's fault";
  EXPECT_EQ(state.malformed(), wrong.size());
}

TEST_F(Vmc, MarkersWithoutEndAreCountedAsInputThatWasLost) {
  VmcState state(avatar_, glm::dvec3(0));
  OscBuilder text(lo_message_new());
  lo_message_add_string(text.get(), "here");
  const auto marker = bytes_of("/vestige/marker", text);
  for (int i = 0; i < 1003; ++i) state.take(marker);
  EXPECT_EQ(state.markers().size(), 1000U);
  EXPECT_EQ(state.malformed(), 3U);
  state.forget_markers();
  state.take(marker);
  EXPECT_EQ(state.markers().size(), 1U);
}

TEST_F(Vmc, AnAvatarWithoutABodyIsRefused) {
  EXPECT_THROW(VmcState(test::skeleton(3), glm::dvec3(0)), Error);
}

}  // namespace
}  // namespace vestige
