// Live input: lines of JSON, and the VMC protocol.

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
#include "traces/live/live_ndjson.hpp"
#include "traces/live/osc_packet.hpp"
#include "traces/live/vmc_state.hpp"
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
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;
using ::testing::UnorderedElementsAre;

// Lines of JSON.

class LiveLines : public ::testing::Test {
 protected:
  std::vector<TraceFrame> read(std::string_view text, std::size_t piece = 1 << 20, std::int64_t now_ns = 7) {
    lines_ = std::make_unique<LiveNdjson>(avatar_);
    std::vector<TraceFrame> frames;
    const auto take = [&](TraceFrame frame) { frames.push_back(std::move(frame)); };
    for (std::size_t at = 0; at < text.size(); at += piece) lines_->push(text.substr(at, piece), now_ns, take);
    lines_->finish(now_ns, take);
    return frames;
  }

  const Avatar avatar_ = test::skeleton(2);
  std::unique_ptr<LiveNdjson> lines_;
};

constexpr std::string_view kWhole =
    R"({"frame":4,"time_s":0.5,"pose":{"origin":[0.1,-0.0,1e300],"nodes":[[1,2,3,0,0,0,1,1,1,1],)"
    R"([0.1,-0.0,"inf",0.5,0.5,0.5,0.5,"nan",2,3]]},"colliders":[{"id":3,"position":[0.2,1.1,0.4]}],"teleported":[3]})"
    "\n";

TEST_F(LiveLines, AreFramesToTheBit) {
  for (const std::size_t piece : {std::size_t{1}, std::size_t{7}, kWhole.size()}) {
    const auto frames = read(kWhole, piece);
    ASSERT_EQ(frames.size(), 1U) << piece;
    const TraceFrame& frame = frames[0];
    EXPECT_EQ(frame.index, 4U);
    EXPECT_EQ(frame.time_ns, 500'000'000);
    EXPECT_TRUE(test::same_bits(frame.pose.origin_m, glm::dvec3(0.1, -0.0, 1e300)));
    EXPECT_EQ(frame.pose.nodes[1].translation.x, 0.1F);
    EXPECT_TRUE(std::signbit(frame.pose.nodes[1].translation.y));
    EXPECT_TRUE(std::isinf(frame.pose.nodes[1].translation.z));
    EXPECT_TRUE(std::isnan(frame.pose.nodes[1].scale.x));
    ASSERT_EQ(frame.colliders.size(), 1U);
    EXPECT_EQ(frame.colliders[0].id, 3U);
    EXPECT_EQ(frame.colliders[0].position_m.y, 1.1);
    EXPECT_THAT(frame.teleported, ElementsAre(3U));
    EXPECT_EQ(lines_->malformed(), 0U);
  }
}

TEST_F(LiveLines, MayLeaveOutAllButTheBraces) {
  const auto frames = read("{}\r\n\n{\"pose\":{\"joints\":{\"" + std::string("node 1 \\\"\\u00e9\\\"") +
                           "\":{\"t\":[0,5,0]}}}}\n{\"time_s\":1}");
  ASSERT_EQ(frames.size(), 3U) << ::testing::PrintToString(lines_->problems());
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(frames[i].index, i);
  EXPECT_EQ(frames[0].time_ns, 7) << "when the line came";
  EXPECT_EQ(frames[0].pose.origin_m, glm::dvec3(0));
  EXPECT_EQ(frames[1].pose.nodes[1].translation.y, 5.0F);
  EXPECT_EQ(frames[2].pose.nodes[1].translation.y, 5.0F) << "as the line before";
  EXPECT_EQ(frames[2].time_ns, 1'000'000'000);
}

TEST_F(LiveLines, FieldsThatMeanNothingAreToldOfOnce) {
  const auto frames = read(R"({"colider": []}
{"colider": [], "pose": {"joint": 1, "joints": {}}}
)");
  EXPECT_THAT(frames, SizeIs(2));
  EXPECT_EQ(lines_->malformed(), 0U);
  EXPECT_THAT(lines_->problems(),
              ElementsAre(AllOf(HasSubstr("line 1"), HasSubstr("'colider'"), HasSubstr("colliders")),
                          AllOf(HasSubstr("line 2"), HasSubstr("'joint'"))));
}

TEST_F(LiveLines, ThatAreWrongAreLeftOutAndCounted) {
  const std::string long_line = std::string(17 << 20, 'x') + "\n";
  const std::vector<std::string> wrong = {
      "nonsense\n",
      "[1,2]\n",
      "{\"frame\":-1}\n",
      "{\"frame\":4294967296}\n",
      "{\"time_s\":-1}\n",
      "{\"time_s\":\"inf\"}\n",
      "{\"time_s\":1e300}\n",
      "{\"time_s\":\"soon\"}\n",
      "{\"pose\":5}\n",
      "{\"pose\":{\"x\":" + std::string(100000, '[') + std::string(100000, ']') + ",\"nodes\":[1e39]}}\n",
      "{\"pose\":{}}\n",
      "{\"pose\":{\"nodes\":[]}}\n",
      "{\"pose\":{\"nodes\":[[1,2],[3]]}}\n",
      "{\"pose\":{\"joints\":{\"nobody\":{}}}}\n",
      "{\"colliders\":5}\n",
      "{\"colliders\":[5]}\n",
      "{\"colliders\":[{\"id\":-1,\"position\":[0,0,0]}]}\n",
      "{\"colliders\":[{\"id\":1,\"position\":[0,0]}]}\n",
      "{\"colliders\":[{\"id\":1,\"position\":[0,0,0]},{\"id\":1,\"position\":[0,0,0]}]}\n",
      "{\"colliders\":[{\"id\":1,\"position\":[0,0,0],\"radius\":-1}]}\n",
      "{\"colliders\":[{\"id\":1,\"position\":[0,0,0],\"radius\":11}]}\n",
      "{\"colliders\":[{\"id\":1,\"position\":[0,0,0],\"radius\":\"nan\"}]}\n",
      "{\"colliders\":[{\"id\":1,\"position\":[0,0,0],\"radius\":[1]}]}\n",
      "{\"teleported\":{}}\n",
      "{\"frame\":0}\n",
      "{\"time_s\":0.4}\n",
      long_line,
  };
  for (const std::string& line : wrong) {
    const auto frames = read(std::string(kWhole) + line + "{}\n");
    EXPECT_EQ(frames.size(), 2U) << line.substr(0, 80);
    EXPECT_EQ(lines_->malformed(), 1U) << line.substr(0, 80);
    ASSERT_THAT(lines_->problems(), SizeIs(1));
    EXPECT_THAT(lines_->problems()[0], HasSubstr("line 2: ")) << line.substr(0, 80);
    EXPECT_EQ(frames.back().index, 5U);
  }
}

TEST_F(LiveLines, BehindTheLastNumberAreLeftOut) {
  EXPECT_THAT(read("{\"frame\":4294967295}\n{}\n{}\n"), SizeIs(1));
  EXPECT_EQ(lines_->malformed(), 2U);
}

TEST_F(LiveLines, SayWhereANumberIsMissing) {
  read("{\"time_s\":\"soon\"}\n{\"colliders\":[{\"id\":1,\"position\":[0,null,0]}]}\n");
  EXPECT_THAT(lines_->problems(), ElementsAre("line 1: 'time_s' has string instead of a number",
                                              "line 2: 'position' has null instead of a number"));
}

// Open Sound Control.

TEST(OscPacket, HoldsMessagesOfBundlesWithinBundles) {
  const auto packet =
      bundle({collider(1, 0, 0, 0), bundle({collider(2, 0, 0, 0), bundle({})}), collider(3, 0.5F, 0, 0)});
  const auto messages = decode_osc_packet(packet);
  ASSERT_EQ(messages.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(messages[i].address, "/vestige/collider");
    EXPECT_EQ(std::get<std::int32_t>(messages[i].arguments[0]), static_cast<std::int32_t>(i + 1));
  }
  EXPECT_EQ(std::get<float>(messages[2].arguments[1]), 0.5F);
}

/// Arguments stand on multiples of 4, wherever liblo's union would want to be.
TEST(OscPacket, AStringMayFollowANumber) {
  for (std::size_t numbers = 0; numbers < 3; ++numbers) {
    const OscBuilder message(lo_message_new());
    for (std::size_t i = 0; i < numbers; ++i) lo_message_add_float(message.get(), 0.5F);
    lo_message_add_string(message.get(), "Hips");
    lo_message_add_double(message.get(), 2.5);
    const auto messages = decode_osc_packet(bytes_of("/VMC/Ext/Bone/Pos", message));
    ASSERT_THAT(messages, SizeIs(1));
    const std::vector<OscArgument>& arguments = messages[0].arguments;
    ASSERT_THAT(arguments, SizeIs(numbers + 2));
    EXPECT_EQ(std::get<std::string>(arguments[numbers]), "Hips");
    EXPECT_EQ(std::get<double>(arguments.back()), 2.5);
  }
}

TEST(OscPacket, CutAnywhereOrFlippedAnywhereIsRefusedOrRead) {
  const auto packet = bundle({bone("Hips", {1, 0, 0, 0}), bundle({collider(2, 1, 2, 3)})});
  for (std::size_t length = 0; length < packet.size(); ++length) {
    // A bundle may end after its time, or after any element.
    try {
      EXPECT_LT(decode_osc_packet(std::span(packet).first(length)).size(), 2U) << length;
    } catch (const mcap::Malformed&) {
      continue;
    }
  }
  for (std::size_t at = 0; at < packet.size(); ++at) {
    for (int flip = 1; flip < 256; flip += flip < 8 ? 1 : 31) {
      auto damaged = packet;
      damaged[at] ^= static_cast<std::byte>(flip);
      try {
        EXPECT_LE(decode_osc_packet(damaged).size(), 2U);
      } catch (const mcap::Malformed&) {
        continue;
      }
    }
  }
}

TEST(OscPacket, NestedWithoutEndIsRefused) {
  std::vector<std::byte> packet = bundle({});
  for (int i = 0; i < 100; ++i) packet = bundle({packet});
  EXPECT_THROW(decode_osc_packet(packet), mcap::Malformed);
}

// The body.

TEST(Humanoid, HasUnitysNamesWhateverTheJointsAreCalled) {
  const std::vector<std::pair<const char*, const char*>> bones = {
      {"mixamorig:Hips", "Hips"},         {"mixamorig:Spine", "Spine"},
      {"mixamorig:Spine1", "Chest"},      {"mixamorig:Spine2", "UpperChest"},
      {"mixamorig:Neck", "Neck"},         {"mixamorig:Head", "Head"},
      {"clavicle_r", "RightShoulder"},    {"upperarm_l", "LeftUpperArm"},
      {"LeftForeArm", "LeftLowerArm"},    {"mixamorig:RightHandIndex2", "RightIndexIntermediate"},
      {"thumb_03_r", "RightThumbDistal"}, {"mixamorig:LeftUpLeg", "LeftUpperLeg"},
      {"shin.R", "RightLowerLeg"},        {"Sword", ""}};
  Avatar avatar = test::skeleton(bones.size());  // each joint hangs from the one before
  for (std::size_t i = 0; i < bones.size(); ++i) avatar.nodes[i].name = bones[i].first;
  const Humanoid humanoid = find_humanoid(avatar, "{}");
  for (std::size_t i = 0; i < bones.size(); ++i) {
    const std::string bone = bones[i].second;
    if (bone.empty()) continue;
    ASSERT_TRUE(humanoid.node_of.contains(bone)) << bone;
    EXPECT_EQ(humanoid.node_of.find(bone)->second, i) << bone;
  }
  EXPECT_EQ(humanoid.node_of.size(), bones.size() - 1);
}

TEST(Humanoid, OfTheBuiltInAvatarIsWhole) {
  const Humanoid humanoid = test::builtin_avatar().humanoid;
  EXPECT_EQ(humanoid.node_of.size(), 21U);
  for (const char* name : {"Hips", "Spine", "Chest", "Neck", "Head", "LeftUpperArm", "RightLowerLeg", "LeftToes"})
    EXPECT_TRUE(humanoid.node_of.contains(name)) << name;
}

TEST(Humanoid, OfBonesInOnePlaceTheSecondIsLeftOutAndSaid) {
  const Humanoid humanoid = find_humanoid(test::skeleton(4), R"({"VRMC_vrm":{"humanoid":{"humanBones":)"
                                                             R"({"head":{"node":2},"hips":{"node":2}}}}})");
  EXPECT_EQ(humanoid.node_of, (decltype(humanoid.node_of){{"Head", 2}}));
  ASSERT_EQ(humanoid.problems.size(), 1U);
  EXPECT_THAT(humanoid.problems.front(), HasSubstr("humanBones.hips.node is 2, which is already the bone Head"));
}

TEST(Humanoid, IsWhatVrmSays) {
  const Avatar avatar = test::skeleton(4);
  const Humanoid one = find_humanoid(avatar, R"({"VRMC_vrm":{"humanoid":{"humanBones":{"hips":{"node":2},)"
                                             R"("leftThumbMetacarpal":{"node":3},"head":{"node":99},"jaw":5}}}})");
  EXPECT_EQ(one.source, Humanoid::Source::kVrm1);
  EXPECT_EQ(one.node_of, (decltype(one.node_of){{"Hips", 2}, {"LeftThumbProximal", 3}}));
  const std::string field = "extensions.VRMC_vrm.humanoid.humanBones.";
  EXPECT_THAT(one.problems,
              UnorderedElementsAre(field + "head.node is not a node of the file: the bone Head is left out",
                                   field + "jaw.node is not a node of the file: the bone Jaw is left out"));
  const Humanoid zero =
      find_humanoid(avatar, R"({"VRM":{"humanoid":{"humanBones":[{"bone":"hips","node":1},{"bone":7},5,)"
                            R"({"bone":"leftUpperArm","node":0}]}}})");
  EXPECT_EQ(zero.source, Humanoid::Source::kVrm0);
  EXPECT_EQ(zero.node_of, (decltype(zero.node_of){{"Hips", 1}, {"LeftUpperArm", 0}}));
}

TEST(Humanoid, OfTwoTablesOfVrmIsTheOneThatNamesBones) {
  const auto found = [](const std::string& vrm1, const std::string& vrm0) {
    return find_humanoid(test::skeleton(4), R"({"VRMC_vrm":{"humanoid":{"humanBones":)" + vrm1 +
                                                R"(}},"VRM":{"humanoid":{"humanBones":)" + vrm0 + "}}}");
  };
  for (const char* empty : {"{}", "[]", "null", R"({"wing":{"node":1}})", R"({"hips":{"node":4}})"}) {
    const Humanoid old = found(empty, R"([{"bone":"hips","node":1}])");
    EXPECT_EQ(old.source, Humanoid::Source::kVrm0) << empty;
    EXPECT_EQ(old.node_of, (decltype(old.node_of){{"Hips", 1}})) << empty;
  }
  const Humanoid now = found(R"({"hips":{"node":2}})", R"([{"bone":"hips","node":1},{"bone":"head","node":3}])");
  EXPECT_EQ(now.source, Humanoid::Source::kVrm1);
  EXPECT_EQ(now.node_of, (decltype(now.node_of){{"Hips", 2}}));
  EXPECT_EQ(found("{}", "[]").source, Humanoid::Source::kVrm1);
}

// VMC.

class Vmc : public ::testing::Test {
 protected:
  /// World positions of nodes in the state's pose, without the origin.
  std::vector<glm::dvec3> joints(VmcState& state) const {
    TraceFrame frame;
    state.show(frame);
    std::vector<glm::dmat4> world;
    world_matrices(avatar_, frame.pose, world);
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
  EXPECT_EQ(frame.pose.origin_m, glm::dvec3(5, 6, 7));
  const Pose rest = rest_pose(avatar_);
  for (std::size_t i = 0; i < rest.nodes.size(); ++i) {
    expect_near(frame.pose.nodes[i].translation, rest.nodes[i].translation);
    EXPECT_NEAR(std::abs(glm::dot(glm::dquat(frame.pose.nodes[i].rotation), glm::dquat(rest.nodes[i].rotation))), 1,
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
  world_matrices(avatar_, frame.pose, world);
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
  world_matrices(avatar, frame.pose, world);
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
  EXPECT_EQ(frame.pose.origin_m, glm::dvec3(5, 6, 7));
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
