#include "traces/scene/pose.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>

#include "traces/scene/avatar.hpp"

namespace vestige {
namespace {

/// An avatar of `count` nodes, each the child of the one before.
Avatar chain(int count) {
  Avatar avatar;
  for (int i = 0; i < count; ++i) {
    avatar.nodes.push_back({"", i - 1, {}, std::nullopt});
    avatar.node_order.push_back(i);
  }
  return avatar;
}

Animation one_channel(AnimatedProperty property, Interpolation interpolation, std::vector<float> times_s,
                      std::vector<float> values) {
  Animation animation;
  animation.duration_s = double{times_s.back()};
  animation.channels.push_back({0, property, interpolation, std::move(times_s), std::move(values)});
  return animation;
}

float x_at(const Animation& animation, double time_s) {
  return sample_animation(chain(1), animation, time_s).nodes[0].translation.x;
}

glm::quat rotation_at(const Animation& animation, double time_s) {
  return sample_animation(chain(1), animation, time_s).nodes[0].rotation;
}

/// x y z w of a turn about z.
std::vector<float> turn(double degrees) {
  const double half = degrees * glm::pi<double>() / 360;
  return {0, 0, static_cast<float>(std::sin(half)), static_cast<float>(std::cos(half))};
}

std::vector<float> join(std::vector<float> a, const std::vector<float>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

double degrees_about_z(const glm::quat& q) {
  return 2 * std::atan2(double{q.z}, double{q.w}) * 180 / glm::pi<double>();
}

TEST(SampleAnimation, KeepsAStepUntilTheNextKey) {
  const Animation steps =
      one_channel(AnimatedProperty::kTranslation, Interpolation::kStep, {1, 2, 4}, {10, 0, 0, 20, 0, 0, 40, 0, 0});
  EXPECT_EQ(x_at(steps, 1), 10);
  EXPECT_EQ(x_at(steps, 1.999999), 10);
  EXPECT_EQ(x_at(steps, 2), 20);
  EXPECT_EQ(x_at(steps, 3.999999), 20);
  EXPECT_EQ(x_at(steps, 4), 40);
}

TEST(SampleAnimation, InterpolatesLinearlyBetweenUnevenKeys) {
  const Animation line =
      one_channel(AnimatedProperty::kTranslation, Interpolation::kLinear, {1, 2, 4}, {10, 0, 0, 20, 0, 0, 40, 0, 0});
  EXPECT_EQ(x_at(line, 1.5), 15);
  EXPECT_EQ(x_at(line, 2), 20);
  EXPECT_EQ(x_at(line, 3.5), 35);
}

TEST(SampleAnimation, ClampsOutsideTheKeysAndForTimesThatAreNone) {
  for (const Interpolation kind : {Interpolation::kStep, Interpolation::kLinear}) {
    const Animation animation = one_channel(AnimatedProperty::kTranslation, kind, {1, 2}, {10, 0, 0, 20, 0, 0});
    EXPECT_EQ(x_at(animation, -std::numeric_limits<double>::infinity()), 10);
    EXPECT_EQ(x_at(animation, 0), 10);
    EXPECT_EQ(x_at(animation, 1e9), 20);
    EXPECT_EQ(x_at(animation, std::numeric_limits<double>::quiet_NaN()), 10);
  }
}

TEST(SampleAnimation, HoldsASingleKey) {
  const Animation one = one_channel(AnimatedProperty::kTranslation, Interpolation::kLinear, {3}, {7, 0, 0});
  for (const double time_s : {0.0, 3.0, 5.0}) EXPECT_EQ(x_at(one, time_s), 7);
}

TEST(SampleAnimation, FollowsTheHermiteSplineOfAppendixC) {
  // In-tangent, value, out-tangent of each key. From 1 at 0 s with slope 3 to 2 at 2 s with slope -1.
  const Animation spline = one_channel(AnimatedProperty::kTranslation, Interpolation::kCubicSpline, {0, 2},
                                       {9, 0, 0, 1, 0, 0, 3, 0, 0, -1, 0, 0, 2, 0, 0, 9, 0, 0});
  EXPECT_EQ(x_at(spline, 0), 1);
  EXPECT_EQ(x_at(spline, 2), 2);
  EXPECT_EQ(x_at(spline, 3), 2);
  // Half way: (1 + 2) / 2 + 2 s * (3 - -1) / 8.
  EXPECT_FLOAT_EQ(x_at(spline, 1), 2.5F);
  // A quarter: h00 = 27/32, h10 = 9/64, h01 = 5/32, h11 = -3/64.
  EXPECT_FLOAT_EQ(x_at(spline, 0.5), 27.0F / 32 + 2 * 3 * 9.0F / 64 + 2 * 5.0F / 32 + 2 * 3.0F / 64);
}

TEST(SampleAnimation, TurnsAtAnEvenRateAlongTheShorterArc) {
  const Animation turning =
      one_channel(AnimatedProperty::kRotation, Interpolation::kLinear, {0, 1}, join(turn(0), turn(120)));
  EXPECT_NEAR(degrees_about_z(rotation_at(turning, 0.25)), 30, 1e-5);
  EXPECT_NEAR(degrees_about_z(rotation_at(turning, 0.5)), 60, 1e-5);

  // The same end, written as the opposite quaternion: not the long way round.
  std::vector<float> opposite = turn(120);
  for (float& number : opposite) number = -number;
  const Animation same =
      one_channel(AnimatedProperty::kRotation, Interpolation::kLinear, {0, 1}, join(turn(0), opposite));
  EXPECT_NEAR(degrees_about_z(rotation_at(same, 0.25)), 30, 1e-5);
}

TEST(SampleAnimation, KeepsRotationsAtUnitLengthWhateverTheFileSays) {
  std::vector<float> doubled = turn(90);
  for (float& number : doubled) number *= 2;
  for (const Interpolation kind : {Interpolation::kStep, Interpolation::kLinear}) {
    const Animation animation = one_channel(AnimatedProperty::kRotation, kind, {0, 1}, join(doubled, turn(0)));
    for (const double time_s : {0.0, 0.3, 1.0}) {
      EXPECT_NEAR(glm::length(glm::dquat(rotation_at(animation, time_s))), 1, 1e-7) << time_s;
    }
    EXPECT_NEAR(degrees_about_z(rotation_at(animation, 0)), 90, 1e-5);
  }
}

TEST(SampleAnimation, StandsStillBetweenEqualOrNearlyEqualRotations) {
  for (const double degrees : {0.0, 1e-12, 1e-7, 1e-5}) {
    const Animation still =
        one_channel(AnimatedProperty::kRotation, Interpolation::kLinear, {0, 1}, join(turn(40), turn(40 + degrees)));
    EXPECT_NEAR(degrees_about_z(rotation_at(still, 0.5)), 40 + degrees / 2, 1e-5) << degrees;
  }
}

TEST(SampleAnimation, GivesSomeRotationWhereASplinePassesThroughZero) {
  // From q to -q with no tangents the spline is zero half way.
  const std::vector<float> zero(4, 0);
  std::vector<float> values;
  for (const auto& part : {zero, turn(0), zero, zero, std::vector<float>{0, 0, 0, -1}, zero})
    values = join(values, part);
  const Animation spline = one_channel(AnimatedProperty::kRotation, Interpolation::kCubicSpline, {0, 1}, values);
  EXPECT_EQ(rotation_at(spline, 0.5), glm::quat(1, 0, 0, 0));
}

TEST(SampleAnimation, LeavesOtherNodesAndPropertiesAtRest) {
  Avatar avatar = chain(2);
  avatar.nodes[0].rest.scale = glm::vec3(3);
  avatar.nodes[1].rest.translation = glm::vec3(4);
  const Animation animation =
      one_channel(AnimatedProperty::kTranslation, Interpolation::kLinear, {0, 1}, {0, 0, 0, 1, 0, 0});
  const Pose pose = sample_animation(avatar, animation, 0.5);
  ASSERT_EQ(pose.nodes.size(), 2U);
  EXPECT_EQ(pose.nodes[0].scale, glm::vec3(3));
  EXPECT_EQ(pose.nodes[1].translation, glm::vec3(4));
}

TEST(SampleAnimation, RoundsOnceFromDouble) {
  // (1 - t) a + t b in single precision would round three times; a third of the way it shows.
  const Animation line =
      one_channel(AnimatedProperty::kTranslation, Interpolation::kLinear, {0, 3}, {16777216, 0, 0, 16777220, 0, 0});
  EXPECT_EQ(x_at(line, 1), static_cast<float>((1 - 1.0 / 3) * 16777216.0 + 16777220.0 / 3));
}

TEST(WorldMatrices, ScaleFirstThenRotateThenTranslate) {
  Avatar avatar = chain(2);
  avatar.nodes[0].rest.translation = glm::vec3(10, 0, 0);
  avatar.nodes[0].rest.rotation = glm::quat(glm::angleAxis(glm::half_pi<double>(), glm::dvec3(0, 0, 1)));
  avatar.nodes[0].rest.scale = glm::vec3(2, 3, 4);
  avatar.nodes[1].rest.translation = glm::vec3(1, 1, 1);
  std::vector<glm::dmat4> world;
  world_matrices(avatar, rest_pose(avatar), world);
  // (1, 1, 1) scaled is (2, 3, 4), turned (-3, 2, 4), moved (7, 2, 4).
  EXPECT_NEAR(world[1][3].x, 7, 1e-6);
  EXPECT_NEAR(world[1][3].y, 2, 1e-6);
  EXPECT_NEAR(world[1][3].z, 4, 1e-6);
}

TEST(WorldMatrices, NormaliseRotationsAndPreferAFixedMatrix) {
  Avatar avatar = chain(2);
  avatar.nodes[0].rest.rotation = glm::quat(5, 0, 0, 0);
  glm::dmat4 shear(1.0);
  shear[1][0] = 0.5;
  avatar.nodes[1].fixed_matrix = shear;
  avatar.nodes[1].rest.translation = glm::vec3(9);
  std::vector<glm::dmat4> world;
  world_matrices(avatar, rest_pose(avatar), world);
  EXPECT_EQ(world[0], glm::dmat4(1.0));
  EXPECT_EQ(world[1], shear);
}

TEST(WorldMatrices, LeaveThePosesOriginOut) {
  const Avatar avatar = chain(1);
  Pose pose = rest_pose(avatar);
  pose.origin_m = glm::dvec3(1e7, 0, 0);
  std::vector<glm::dmat4> world;
  world_matrices(avatar, pose, world);
  EXPECT_EQ(world[0], glm::dmat4(1.0));
}

}  // namespace
}  // namespace vestige
