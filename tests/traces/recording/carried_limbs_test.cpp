#include "traces/recording/carried_limbs.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "tests/support/builtin_avatar.hpp"
#include "traces/scene/pose.hpp"

namespace vestige {
namespace {

TEST(CarriedLimbs, GoWhereTheirPersonTakesThem) {
  const Avatar& avatar = test::builtin_avatar();
  const std::vector<LimbSphere> hand = fit_limb(avatar, "hand_left");
  CarriedLimbs limbs(40);
  limbs.add(0, avatar, hand);
  limbs.add(1, avatar, fit_limb(avatar, "head"));
  TraceFrame frame;
  frame.poses = {rest_pose(avatar), rest_pose(avatar)};
  frame.poses[1].origin_m = {5, 0, 0};
  frame.colliders = {{.id = 7}};
  limbs.carry(frame);
  ASSERT_EQ(frame.colliders.size(), 1 + limbs.sphere_count());
  const ColliderSample first = frame.colliders[1];
  for (std::size_t i = 1; i < frame.colliders.size(); ++i) {
    EXPECT_EQ(frame.colliders[i].id, 39 + i);
    EXPECT_EQ(frame.colliders[i].owner, i <= hand.size() ? 1U : 2U);
    EXPECT_GT(frame.colliders[i].radius_m, 0);
  }
  EXPECT_NEAR(frame.colliders.back().position_m.x, 5, 0.05) << "a head in the middle of its body";

  // The elbow bends by a quarter turn: the hand goes with it, at its distance from the elbow.
  const std::size_t elbow = avatar.humanoid.node_of.find("LeftLowerArm")->second;
  std::vector<glm::dmat4> world;
  world_matrices(avatar, frame.poses[0], world);
  const glm::dvec3 elbow_m(world[elbow][3]);
  frame.poses[0].nodes[elbow].rotation =
      glm::angleAxis(glm::radians(90.0F), glm::vec3(0, 1, 0)) * frame.poses[0].nodes[elbow].rotation;
  frame.colliders.clear();
  limbs.carry(frame);
  const ColliderSample& bent = frame.colliders.front();
  EXPECT_GT(glm::distance(bent.position_m, first.position_m), 0.2);
  EXPECT_NEAR(glm::distance(bent.position_m, elbow_m), glm::distance(first.position_m, elbow_m), 1e-4);
}

TEST(CarriedLimbs, OfAMissingPoseStayAway) {
  const Avatar& avatar = test::builtin_avatar();
  CarriedLimbs limbs(0);
  limbs.add(1, avatar, fit_limb(avatar, "head"));
  TraceFrame frame;
  frame.poses = {rest_pose(avatar), Pose()};
  limbs.carry(frame);
  EXPECT_TRUE(frame.colliders.empty());
}

}  // namespace
}  // namespace vestige
