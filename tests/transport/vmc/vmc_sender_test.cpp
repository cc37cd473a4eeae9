// Plays people by the VMC protocol to the state that a live recording takes them into.

#include "transport/vmc/vmc_sender.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "tests/support/builtin_avatar.hpp"
#include "tests/support/made/edited_glb.hpp"
#include "tests/support/udp.hpp"
#include "tests/traces/trace_file/trace_fixture.hpp"
#include "traces/base/error.hpp"
#include "traces/live/udp_receiver.hpp"
#include "traces/scene/reference_skinning.hpp"

namespace vestige {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A pose of the bones of a body that VMC can say: bones turn, the hips and the top also move.
Pose dancing(const Avatar& avatar, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> some;
  const VmcSkeleton skeleton = vmc_skeleton(avatar, "avatar");
  Pose pose = rest_pose(avatar);
  pose.origin_m = {3, 0.25, -2};
  const auto turn = [&](NodeLocal& node) {
    node.rotation = glm::normalize(glm::quat(some(random), some(random), some(random), some(random)));
  };
  for (const auto& [name, bone] : skeleton.bones) turn(pose.nodes[bone.node]);
  turn(pose.nodes[skeleton.top]);
  pose.nodes[skeleton.top].translation += glm::vec3(some(random), some(random), some(random));
  pose.nodes[avatar.humanoid.node_of.find("Hips")->second].translation += glm::vec3(0.3F, -0.1F, 0.2F);
  return pose;
}

/// Returns what a receiver shows after it has heard a pose.
Pose heard(const Avatar& avatar, const Pose& pose) {
  VmcState receiver(avatar, glm::dvec3(0));
  for (const OscBytes& message : pose_messages(vmc_skeleton(avatar, "avatar"), avatar, pose)) receiver.take(message);
  EXPECT_EQ(receiver.malformed(), 0U);
  TraceFrame frame;
  receiver.show(frame);
  return frame.poses.front();
}

/// The largest distance between the skins of two poses.
double apart(const Avatar& avatar, const Pose& a, const Pose& b) {
  double most = 0;
  std::vector<glm::dvec3> skin_a;
  std::vector<glm::dvec3> skin_b;
  skin_reference(avatar, a, glm::dvec3(0), skin_a);
  skin_reference(avatar, b, glm::dvec3(0), skin_b);
  for (std::size_t v = 0; v < skin_a.size(); ++v) most = std::max(most, glm::length(skin_a[v] - skin_b[v]));
  return most;
}

constexpr double kSinglePrecision_m = 1e-5;  // of some 3 m, through a chain of ten joints

TEST(VmcMessages, APoseComesBackWhicheverWayTheAvatarFaces) {
  for (int quarters = 0; quarters < 4; ++quarters) {
    const Avatar avatar = parse_avatar_glb(test::turned_glb(builtin_avatar_glb(), quarters), "turned.glb");
    for (unsigned seed = 0; seed < 5; ++seed) {
      const Pose pose = dancing(avatar, seed);
      EXPECT_LT(apart(avatar, pose, heard(avatar, pose)), kSinglePrecision_m) << quarters << " " << seed;
    }
  }
}

TEST(VmcMessages, APoseComesBackBelowANodeThatScalesTurnsAndMoves) {
  const Avatar avatar = parse_avatar_glb(test::edited_glb(builtin_avatar_glb(),
                                                          [](nlohmann::json& json) {
                                                            test::hang_below(json, {{"name", "armature"},
                                                                                    {"translation", {0.1, 0.2, 0.3}},
                                                                                    {"rotation", {0, 0.6, 0, 0.8}},
                                                                                    {"scale", {0.5, 0.5, 0.5}}});
                                                          }),
                                         "scaled.glb");
  for (unsigned seed = 0; seed < 5; ++seed) {
    const Pose pose = dancing(avatar, seed);
    EXPECT_LT(apart(avatar, pose, heard(avatar, pose)), kSinglePrecision_m) << seed;
  }
}

TEST(VmcMessages, APoseComesBackWhereTheHipsAreTheOutermostNode) {
  Avatar avatar = test::skeleton(2);
  avatar.nodes[0].rest = {.translation = {0, 0.9F, 0}, .rotation = glm::normalize(glm::quat(1, 0.5F, 0, 0.2F))};
  avatar.nodes[1].rest = {.translation = {0, 0.3F, 0}, .rotation = glm::normalize(glm::quat(1, 0, 0.7F, 0))};
  avatar.humanoid.node_of = {{"Hips", 0}, {"Spine", 1}};
  const Pose pose = dancing(avatar, 1);
  std::vector<glm::dmat4> sent;
  std::vector<glm::dmat4> taken;
  const Pose back = heard(avatar, pose);
  world_matrices(avatar, pose, sent);
  world_matrices(avatar, back, taken);
  for (std::size_t i = 0; i < sent.size(); ++i) {
    const glm::dmat4 difference = sent[i] - taken[i];
    for (int column = 0; column < 3; ++column) EXPECT_LT(glm::length(difference[column]), kSinglePrecision_m);
    EXPECT_LT(glm::length(glm::dvec3(difference[3]) + pose.origin_m - back.origin_m), kSinglePrecision_m);
  }
}

TEST(SkinDifference, IsNeverLessThanTheSkinMovesAndNothingForOnePose) {
  const Avatar& avatar = test::builtin_avatar();
  SkinDifference difference(avatar);
  for (unsigned seed = 0; seed < 5; ++seed) {
    const Pose a = dancing(avatar, seed);
    Pose b = a;
    NodeLocal& elbow = b.nodes[avatar.humanoid.node_of.find("LeftLowerArm")->second];
    elbow.scale = glm::vec3(1.5F);
    const SkinDifference::Bound bound = difference.between(a, b);
    EXPECT_GE(bound.most_m, apart(avatar, a, b));
    EXPECT_LT(bound.most_m, 5 * apart(avatar, a, b));
    EXPECT_EQ(difference.between(a, a).most_m, 0);
  }
}

/// A receiver, and a sender to it.
class VmcSending : public ::testing::Test {
 protected:
  VmcSending() {
    for (const double x : {0.1, 0.2, 0.3})
      frame_.colliders.push_back({.id = static_cast<std::uint32_t>(frame_.colliders.size() + 1),
                                  .position_m = {x / 3, 1e6 + x, -x},
                                  .radius_m = static_cast<float>(x)});
    frame_.poses = {rest_pose(avatar_)};
  }

  /// Returns what the receiver shows after all that has arrived.
  TraceFrame received() {
    while (const auto datagram = in_.next()) {
      const std::span<const std::byte> bytes = datagram->bytes;
      EXPECT_LE(bytes.size(), 1400U);
      last_ = std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size());
      state_.take(bytes);
    }
    EXPECT_EQ(state_.malformed(), 0U);
    TraceFrame frame;
    state_.show(frame);
    return frame;
  }

  static std::vector<std::uint32_t> ids_of(const TraceFrame& frame) {
    std::vector<std::uint32_t> ids;
    for (const ColliderSample& collider : frame.colliders) ids.push_back(collider.id);
    return ids;
  }

  void send() { sender_.send(frame_, 0, VmcSender::Clock::now()); }

  const Avatar avatar_ = test::builtin_avatar();
  const HostPort place_ = {"127.0.0.1", test::free_udp_port()};
  UdpReceiver in_{place_, "receiver"};
  VmcState state_{avatar_, glm::dvec3(0)};
  const std::vector<std::uint32_t> ids_ = {1, 2, 3, 4, 5, 4'000'000'000};
  std::vector<std::string> told_;
  VmcSender sender_{
      place_, {0, avatar_, "trace.mcap"}, ids_, [this](const std::string& text) { told_.push_back(text); }};
  TraceFrame frame_;
  std::string last_;
};

TEST_F(VmcSending, CollidersArriveToTheBitAndGoAndJump) {
  EXPECT_FALSE(sender_.is_refused());
  frame_.teleported = {2, 5};  // 5 is absent
  send();
  TraceFrame shown = received();
  ASSERT_EQ(shown.colliders.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(shown.colliders[i].id, frame_.colliders[i].id);
    EXPECT_EQ(shown.colliders[i].position_m, frame_.colliders[i].position_m);
    EXPECT_EQ(shown.colliders[i].radius_m, frame_.colliders[i].radius_m);
  }
  EXPECT_THAT(shown.teleported, ElementsAre(2U));
  EXPECT_THAT(last_.substr(last_.size() - 20), HasSubstr("/VMC/Ext/OK")) << "a frame ends so";

  frame_.teleported.clear();
  frame_.colliders.erase(frame_.colliders.begin());
  send();
  shown = received();
  EXPECT_THAT(ids_of(shown), ElementsAre(2U, 3U));
  EXPECT_THAT(shown.teleported, IsEmpty());
  sender_.begin_run();
  send();
  EXPECT_THAT(received().teleported, ElementsAre(2U, 3U)) << "no way leads from one run to the next";
  send();
  EXPECT_THAT(received().teleported, IsEmpty());
  sender_.finish();
  EXPECT_THAT(ids_of(received()), IsEmpty());
  EXPECT_EQ(sender_.statistics().sent, 4U);
  EXPECT_THAT(told_, IsEmpty());
}

TEST_F(VmcSending, CollidersThatNoMessageCanSayAreLeftOutAndTold) {
  frame_.colliders[0].owner = 1;
  frame_.colliders[1].position_m.y = std::numeric_limits<double>::quiet_NaN();
  frame_.colliders.push_back({.id = 4'000'000'000});
  frame_.colliders.push_back({.id = 4, .position_m = {1e10, 0, 0}});
  frame_.colliders.push_back({.id = 5, .radius_m = 11});
  send();
  send();
  EXPECT_THAT(ids_of(received()), ElementsAre(3U));
  EXPECT_EQ(sender_.colliders_left_out(), 5U);
  EXPECT_THAT(told_, ElementsAre(HasSubstr("limbs of people are not sent"), HasSubstr("collider 2 cannot be sent")));
}

TEST_F(VmcSending, APoseThatNoMessageCanSayIsLeftOutAndTold) {
  frame_.poses[0].nodes[3].rotation.w = std::numeric_limits<float>::infinity();
  send();
  frame_.poses[0] = rest_pose(avatar_);
  frame_.poses[0].origin_m.x = 1e10;
  send();
  EXPECT_EQ(ids_of(received()).size(), 3U) << "colliders are sent all the same";
  EXPECT_TRUE(state_.bones().empty());
  EXPECT_EQ(sender_.statistics().poses_left_out, 2U);
  ASSERT_EQ(told_.size(), 1U);
  EXPECT_THAT(told_[0], HasSubstr("trace.mcap: the pose of frame 0 is not finite"));
}

TEST_F(VmcSending, SaysHowFarTheSkinIsFromTheTraces) {
  send();
  EXPECT_LT(sender_.statistics().deviation.most_m, VmcSender::kToldDeviation_m);
  EXPECT_THAT(told_, IsEmpty());
  frame_.poses[0].nodes[avatar_.humanoid.node_of.find("Head")->second].scale = glm::vec3(2);
  send();
  const double heard_m = apart(avatar_, frame_.poses[0], received().poses[0]);
  EXPECT_GT(heard_m, 0.05);
  EXPECT_GE(sender_.statistics().deviation.most_m, heard_m);
  send();
  ASSERT_EQ(told_.size(), 1U);
  EXPECT_THAT(told_[0], HasSubstr("VMC cannot say the whole pose"));
}

TEST_F(VmcSending, FarFromTheOriginSinglePrecisionIsTold) {
  frame_.poses[0].origin_m.x = 1e6 + 0.03;
  send();
  EXPECT_GT(sender_.statistics().deviation.most_m, 0.02);
  EXPECT_THAT(told_, ElementsAre(HasSubstr("in single precision")));
}

TEST_F(VmcSending, SaysThatNobodyListensAndGoesOn) {
  VmcSender sender({"127.0.0.1", test::free_udp_port()}, {0, avatar_, "trace.mcap"}, {}, [](const std::string&) {});
  EXPECT_TRUE(sender.is_refused());
  for (int i = 0; i < 3; ++i) sender.send(frame_, 0, VmcSender::Clock::now());
  EXPECT_EQ(sender.statistics().sent, 3U);
  EXPECT_EQ(sender.statistics().unsent, 0U);
}

TEST_F(VmcSending, AProbeChangesNothingInAReceiver) {
  EXPECT_FALSE(sender_.is_refused());
  const auto probe = in_.next();
  ASSERT_TRUE(probe);
  EXPECT_FALSE(state_.take(probe->bytes));
  EXPECT_EQ(state_.malformed(), 0U);
}

TEST(VmcSender, RefusesAnAvatarWithoutABodyByTheTracesName) {
  const Avatar bare = test::skeleton(3);
  try {
    const VmcSender sender({"127.0.0.1", 9}, {0, bare, "trace.mcap"}, {}, [](const std::string&) {});
    ADD_FAILURE() << "taken";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("trace.mcap: no joint is recognised as a bone of a human body"));
  }
}

}  // namespace
}  // namespace vestige
