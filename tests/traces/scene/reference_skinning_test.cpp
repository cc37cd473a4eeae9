#include "traces/scene/reference_skinning.hpp"

#include <gtest/gtest.h>

#include "tests/traces/gltf/gltf_builder.hpp"
#include "traces/gltf/avatar_gltf.hpp"

namespace vestige {
namespace {

std::vector<glm::dvec3> skin(const Avatar& avatar, const Pose& pose, const glm::dvec3& origin_m = glm::dvec3(0)) {
  std::vector<glm::dvec3> positions;
  skin_reference(avatar, pose, origin_m, positions);
  return positions;
}

TEST(SkinReference, LeavesTheBindPoseAsItIs) {
  const Avatar avatar = parse_avatar_glb(test::skinned_triangle().glb(), "triangle.glb");
  const std::vector<glm::dvec3> positions = skin(avatar, rest_pose(avatar));
  ASSERT_EQ(positions.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(positions[i], glm::dvec3(avatar.position_bind[i]));
}

TEST(SkinReference, TurnsAVertexAboutItsJoint) {
  const Avatar avatar = parse_avatar_glb(test::skinned_triangle().glb(), "triangle.glb");
  Pose pose = rest_pose(avatar);
  // The upper joint stands at (0, 1, 0), as does the third vertex: moved up, then turned with the lower joint.
  pose.nodes[2].translation = glm::vec3(0, 3, 0);
  pose.nodes[1].rotation = glm::quat(0, 0, 0, 1);
  const std::vector<glm::dvec3> positions = skin(avatar, pose);
  EXPECT_EQ(positions[1], glm::dvec3(-1, 0, 0));
  EXPECT_EQ(positions[2], glm::dvec3(0, -3, 0));
}

TEST(SkinReference, BlendsByWeightsWhoseSumNeedNotBeOne) {
  Avatar avatar = parse_avatar_glb(test::skinned_triangle().glb(), "triangle.glb");
  avatar.influences[0].palette = {0, 1};
  avatar.influences[0].weight = {0.25F, 0.25F};
  Pose pose = rest_pose(avatar);
  pose.nodes[2].translation = glm::vec3(8, 1, 0);
  EXPECT_EQ(skin(avatar, pose)[0], glm::dvec3(4, 0, 0));
}

TEST(SkinReference, IsRelativeToTheGivenOrigin) {
  const Avatar avatar = parse_avatar_glb(test::skinned_triangle().glb(), "triangle.glb");
  Pose pose = rest_pose(avatar);
  pose.origin_m = glm::dvec3(1e7 + 0.25, 2, 3);
  EXPECT_EQ(skin(avatar, pose, glm::dvec3(1e7, 0, 0))[1], glm::dvec3(1.25, 2, 3));
}

}  // namespace
}  // namespace vestige
