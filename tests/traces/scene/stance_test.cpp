// Where a person stands and which way they look.

#include "traces/scene/stance.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <glm/geometric.hpp>

#include "tests/support/builtin_avatar.hpp"
#include "traces/scene/reference_skinning.hpp"

namespace vestige {
namespace {

TEST(Stance, TurnsCounterClockwiseFromAbove) {
  const glm::dvec3 ahead(0, 0, 1);
  EXPECT_EQ(stance_of({}, 0, Facing::kPlusZ).turned(ahead), ahead);
  EXPECT_EQ(stance_of({}, 90, Facing::kPlusZ).turned(ahead), glm::dvec3(1, 0, 0)) << "to the person's left";
  EXPECT_EQ(stance_of({}, -90, Facing::kPlusZ).turned(ahead), glm::dvec3(-1, 0, 0));
  EXPECT_EQ(stance_of({}, 180, Facing::kPlusZ).turned(ahead), glm::dvec3(0, 0, -1));
  EXPECT_EQ(stance_of({}, 720 + 90, Facing::kPlusZ).turned(ahead), glm::dvec3(1, 0, 0));
  const glm::dvec3 between = stance_of({}, 30, Facing::kPlusZ).turned(ahead);
  EXPECT_NEAR(between.x, 0.5, 1e-15);
  EXPECT_NEAR(between.z, 0.8660254037844386, 1e-15);
}

TEST(Stance, MakesEveryAvatarLookAlongPlusZAtFirst) {
  for (const Facing facing : {Facing::kPlusZ, Facing::kPlusX, Facing::kMinusZ, Facing::kMinusX})
    EXPECT_EQ(stance_of({}, 0, facing).turned(forward_of(facing)), glm::dvec3(0, 0, 1)) << to_string(facing);
}

TEST(Stance, MovesTheWholeSkinWithThePose) {
  const Avatar& avatar = test::builtin_avatar();
  const Pose standing = looped_pose(avatar, &avatar.animations.front(), 0.4);
  std::vector<glm::dvec3> before;
  skin_reference(avatar, standing, glm::dvec3(0), before);
  const Stance stance = stance_of({1, 0.25, -3}, 65, avatar.facing.axis);
  Pose moved = standing;
  move_to(stance, avatar, moved);
  std::vector<glm::dvec3> after;
  skin_reference(avatar, moved, glm::dvec3(0), after);
  ASSERT_EQ(before.size(), after.size());
  for (std::size_t i = 0; i < before.size(); ++i)
    EXPECT_LT(glm::distance(stance.turned(before[i]) + stance.position_m, after[i]), 1e-6) << i;
}

TEST(Stance, LeavesTheBitsAloneOfWhoIsNotTurned) {
  const Avatar& avatar = test::builtin_avatar();
  const Pose standing = looped_pose(avatar, &avatar.animations.front(), 0.4);
  Pose moved = standing;
  move_to(stance_of({0, 0, 2}, 360, Facing::kPlusZ), avatar, moved);
  EXPECT_EQ(moved.origin_m, glm::dvec3(0, 0, 2));
  EXPECT_EQ(std::memcmp(moved.nodes.data(), standing.nodes.data(), moved.nodes.size() * sizeof moved.nodes[0]), 0);
}

TEST(Stance, NamesTheRootThatCannotBeTurned) {
  Avatar avatar = test::builtin_avatar();
  EXPECT_EQ(unturnable_root(avatar), "");
  for (Node& node : avatar.nodes)
    if (node.parent < 0) node.fixed_matrix = glm::dmat4(2);
  EXPECT_NE(unturnable_root(avatar), "");
}

}  // namespace
}  // namespace vestige
