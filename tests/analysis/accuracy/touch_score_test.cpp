#include "analysis/accuracy/touch_score.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace vestige {
namespace {

/// An event at `rate_hz` from one frame to another. A sphere that touches at a frame's start touches at t = 0.
ContactEvent event(std::uint32_t column, std::uint16_t actuator, std::uint64_t first, std::uint64_t last,
                   double rate_hz) {
  const auto start_s = [&](std::uint64_t frame) { return (static_cast<double>(frame) - 1) / rate_hz; };
  return {column, actuator, first, last, start_s(first), start_s(last), static_cast<double>(first) / rate_hz};
}

constexpr double kTruth_hz = 1000;
/// Collider 0 touches from 0.199 s to 0.5 s, first over actuator 3, then over 4; collider 1 touches nothing.
const std::vector<ContactEvent> kTruth = {event(0, 3, 200, 400, kTruth_hz), event(0, 4, 401, 500, kTruth_hz)};
/// At 100 Hz the frames 1 to 100 are scored.
const std::vector<bool> kSpheres = {true, true};
const TouchFrames kFrames = {kSpheres, 100, 100, kTruth_hz};

TEST(Touches, AreRunsWhateverTheActuator) {
  const std::vector<ContactEvent> touches =
      touches_of(std::vector<ContactEvent>{event(0, 3, 5, 7, 100), event(0, 4, 8, 9, 100), event(0, 4, 11, 12, 100),
                                           event(1, 4, 13, 13, 100)},
                 kSpheres);
  ASSERT_EQ(touches.size(), 3U);
  EXPECT_EQ(touches[0].first_frame, 5U);
  EXPECT_EQ(touches[0].last_frame, 9U);
  EXPECT_EQ(touches[0].last_s, 0.08);
  EXPECT_EQ(touches[0].actuator, 0);
  EXPECT_EQ(touches[1].first_frame, 11U);
  EXPECT_EQ(touches[2].column, 1U);
}

TEST(Touches, OfPointsStayApart) {
  const std::vector<ContactEvent> events = {event(0, 3, 5, 7, 100), event(0, 4, 8, 9, 100), event(1, 3, 5, 7, 100),
                                            event(1, 4, 8, 9, 100)};
  const std::vector<ContactEvent> touches = touches_of(events, {false, true});
  ASSERT_EQ(touches.size(), 3U);
  EXPECT_EQ(touches[0], events[0]);
  EXPECT_EQ(touches[1], events[1]);
  EXPECT_EQ(touches[2].last_frame, 9U);
}

TEST(TouchScore, LeavesPointsOut) {
  const std::vector<bool> second = {false, true};
  const TouchScore score = score_touches(kTruth, {}, {second, 100, 100, kTruth_hz});
  EXPECT_EQ(score.within, 0U);
  EXPECT_EQ(score.outside, 100U);
}

TEST(TouchScore, CountsFramesThatAreMoreThanOneFrameFromAnEnd) {
  const std::vector<ContactEvent> found = {event(0, 3, 20, 40, 100), event(0, 4, 41, 51, 100)};
  const TouchScore score = score_touches(kTruth, found, kFrames);
  EXPECT_EQ(score.within, 27U) << "frames 22 to 48: their time, and a frame to each side, is from 0.2 s to 0.49 s";
  EXPECT_EQ(score.reported, 27U);
  EXPECT_EQ(score.wrong_actuator, 0U);
  EXPECT_EQ(score.outside, 18U + 48U + 100U) << "frames 1 to 18 and 53 to 100, and all of the other collider";
  EXPECT_EQ(score.false_frames, 0U);
}

TEST(TouchScore, CountsHolesFalseFramesAndWrongActuators) {
  const std::vector<ContactEvent> found = {event(0, 3, 10, 10, 100), event(0, 3, 20, 30, 100), event(0, 3, 35, 51, 100),
                                           event(1, 0, 50, 54, 100)};
  const TouchScore score = score_touches(kTruth, found, kFrames);
  EXPECT_EQ(score.within - score.reported, 4U) << "frames 31 to 34";
  EXPECT_EQ(score.wrong_actuator, 6U) << "frames 43 to 48, in which it has long gone on to actuator 4";
  EXPECT_EQ(score.false_frames, 6U) << "frame 10, and five of the other collider";
}

TEST(TouchScore, AddsUp) {
  TouchScore sum = {5, 4, 3, 2, 1};
  sum += {10, 20, 30, 40, 50};
  EXPECT_EQ(sum.within, 15U);
  EXPECT_EQ(sum.reported, 24U);
  EXPECT_EQ(sum.wrong_actuator, 33U);
  EXPECT_EQ(sum.outside, 42U);
  EXPECT_EQ(sum.false_frames, 51U);
}

}  // namespace
}  // namespace vestige
