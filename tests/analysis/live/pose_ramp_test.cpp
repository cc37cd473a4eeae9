// Poses between poses.

#include "analysis/live/pose_ramp.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace vestige {
namespace {

using namespace std::chrono_literals;

Pose pose_at(double x, double degrees) {
  Pose pose;
  pose.origin_m = {x, 0, 0};
  const double half = degrees * std::numbers::pi / 360;
  pose.nodes.push_back(
      {.translation = {static_cast<float>(2 * x), 0, 0},
       .rotation = glm::quat(static_cast<float>(std::cos(half)), 0, static_cast<float>(std::sin(half)), 0),
       .scale = {1, static_cast<float>(1 + x), 1}});
  return pose;
}

double degrees_of(const Pose& pose) {
  const glm::quat& q = pose.nodes[0].rotation;
  return 2 * std::atan2(double{q.y}, double{q.w}) * 180 / std::numbers::pi;
}

TEST(PoseBetween, IsAtTheSameShareOfEveryWay) {
  const Pose a = pose_at(0, 0);
  const Pose b = pose_at(1, 80);
  const Pose quarter = pose_between(a, b, 0.25);
  EXPECT_EQ(quarter.origin_m.x, 0.25);
  EXPECT_FLOAT_EQ(quarter.nodes[0].translation.x, 0.5F);
  EXPECT_FLOAT_EQ(quarter.nodes[0].scale.y, 1.25F);
  EXPECT_NEAR(degrees_of(quarter), 20, 1e-4) << "turns at a constant speed";
  EXPECT_EQ(pose_between(a, b, 0).nodes[0].rotation, a.nodes[0].rotation);
  EXPECT_EQ(pose_between(a, b, 1).nodes[0].rotation, b.nodes[0].rotation);
}

TEST(PoseBetween, TurnsTheShorterWay) {
  Pose b = pose_at(0, 40);
  b.nodes[0].rotation = -b.nodes[0].rotation;  // the same turn
  const double degrees = degrees_of(pose_between(pose_at(0, 0), b, 0.5));
  EXPECT_NEAR(std::remainder(degrees, 360), 20, 1e-4);
}

TEST(PoseRamp, ShowsTheFirstPoseAtOnceAndOthersOnePoseLate) {
  const PoseRamp::Clock::time_point start{};
  PoseRamp ramp;
  ramp.lead_to(pose_at(1, 0), start, 0ms);
  EXPECT_EQ(ramp.at(start).origin_m.x, 1);
  EXPECT_EQ(ramp.delay_at(start), 0ms);
  ramp.lead_to(pose_at(2, 0), start + 10ms, 10ms);
  EXPECT_EQ(ramp.at(start + 10ms).origin_m.x, 1) << "no frame sees a jump";
  EXPECT_NEAR(ramp.at(start + 13ms).origin_m.x, 1.3, 1e-12);
  EXPECT_EQ(ramp.delay_at(start + 13ms), 10ms);
  EXPECT_EQ(ramp.at(start + 25ms).origin_m.x, 2) << "the next pose is late";
  EXPECT_EQ(ramp.delay_at(start + 25ms), 0ms);
}

TEST(PoseRamp, APoseThatComesEarlyIsLedToFromWhatIsShown) {
  const PoseRamp::Clock::time_point start{};
  PoseRamp ramp;
  ramp.lead_to(pose_at(1, 0), start, 0ms);
  ramp.lead_to(pose_at(2, 0), start + 10ms, 10ms);
  ramp.lead_to(pose_at(3, 0), start + 15ms, 5ms);
  EXPECT_NEAR(ramp.at(start + 15ms).origin_m.x, 1.5, 1e-12);
  EXPECT_NEAR(ramp.at(start + 20ms).origin_m.x, 3, 1e-12);
  ramp.lead_to(pose_at(9, 0), start + 21ms, 0ms);
  EXPECT_EQ(ramp.at(start + 21ms).origin_m.x, 9) << "a length of 0";
}

}  // namespace
}  // namespace vestige
