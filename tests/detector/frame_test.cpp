#include "detector/frame.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "detector/skinning.hpp"
#include "tests/support/small_avatar.hpp"

namespace vestige {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

class FrameBuilderTest : public ::testing::Test {
 protected:
  /// Frame `index`, a millisecond after the one before.
  TraceFrame frame_at(std::uint64_t index, const std::vector<ColliderSample>& colliders) const {
    TraceFrame frame;
    frame.index = index;
    frame.time_ns = static_cast<std::int64_t>(index) * 1000000;
    frame.poses.front() = rest_pose(avatar_);
    frame.colliders = colliders;
    return frame;
  }

  const Avatar avatar_ = test::rigid_avatar({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
  const std::vector<std::uint32_t> ids_ = {3, 7, 9};
};

TEST_F(FrameBuilderTest, TakesARadiusBelowANanometreForAPoint) {
  FrameBuilder builder(avatar_, ids_);
  builder.next(frame_at(0, {{3, {0, 0, 1}}, {7, {0, 0, 1}}, {9, {0, 0, 1}}}));
  const DetectorFrame& frame =
      builder.next(frame_at(1, {{3, {0, 0, 2}, 1e-45F}, {7, {0, 0, 2}, 0x1p-30F}, {9, {0, 0, 2}, 0x1.fffffep-31F}}));
  EXPECT_EQ(frame.segments[0].radius_m, 0);
  EXPECT_EQ(frame.segments[1].radius_m, 0x1p-30F);
  EXPECT_EQ(frame.segments[2].radius_m, 0);
}

TEST_F(FrameBuilderTest, GivesAColliderTheColumnOfItsRankAndASegmentFromItsLastPosition) {
  FrameBuilder builder(avatar_, ids_);
  EXPECT_TRUE(builder.next(frame_at(0, {{9, {0, 0, 1}}, {3, {1, 0, 0}}})).segments.empty());
  const DetectorFrame& frame = builder.next(frame_at(1, {{9, {0, 0, 2}}, {3, {1, 0, 5}}}));
  EXPECT_EQ(frame.columns, 3U);
  EXPECT_DOUBLE_EQ(frame.duration_s, 0.001);
  ASSERT_EQ(frame.segments.size(), 2U);
  EXPECT_EQ(frame.segments[0].column, 0U);
  EXPECT_EQ(frame.segments[0].end, glm::vec3(1, 0, 5));
  EXPECT_EQ(frame.segments[1].column, 2U);
  EXPECT_EQ(frame.segments[1].start, glm::vec3(0, 0, 1));
}

TEST_F(FrameBuilderTest, TakesThePoseOfItsPersonWhomTheirOwnCollidersDoNotTouch) {
  const auto frame_of_two = [this](std::uint64_t index, double y) {
    TraceFrame frame = frame_at(index, {{3, {0, y, 1}, 0, 1}, {7, {0, y, 1}, 0, 2}, {9, {0, y, 1}}});
    frame.poses.push_back(rest_pose(avatar_));
    frame.poses[1].origin_m = {100, 0, 0};
    return frame;
  };
  for (const std::size_t person : {0U, 1U}) {
    FrameBuilder builder(avatar_, ids_, Method::kStatic, person);
    builder.next(frame_of_two(0, 0));
    const DetectorFrame& frame = builder.next(frame_of_two(1, 1));
    EXPECT_EQ(frame.origin_m.x, 100.0 * static_cast<double>(person));
    EXPECT_EQ(frame.columns, 3U) << "a column is the rank of an id in the trace, whoever is touched";
    ASSERT_EQ(frame.segments.size(), 2U);
    EXPECT_EQ(frame.segments[0].column, person == 0 ? 1U : 0U);
    EXPECT_EQ(frame.segments[1].column, 2U);
  }
}

TEST_F(FrameBuilderTest, TakesAMissingPoseForOneThatIsNotFinite) {
  for (const Method method : {Method::kStatic, Method::kCcd}) {
    FrameBuilder builder(avatar_, ids_, method);
    std::vector<std::size_t> segments;
    for (std::uint64_t index = 0; index < 5; ++index) {
      TraceFrame frame = frame_at(index, {{3, {0, 0, static_cast<double>(index)}}});
      if (index == 2) frame.poses.front() = {};
      segments.push_back(builder.next(frame).segments.size());
    }
    EXPECT_EQ(segments, (std::vector<std::size_t>{0, 1, 0, method == Method::kStatic ? 1U : 0U, 1}));
    EXPECT_EQ(builder.non_finite_frames(), 1U);
    EXPECT_EQ(builder.first_non_finite(), 2U);
  }
  FrameBuilder builder(avatar_, ids_);
  TraceFrame first = frame_at(0, {{3, {0, 0, 0}}});
  first.poses.front() = {};
  builder.next(first);
  EXPECT_EQ(builder.next(frame_at(1, {{3, {0, 0, 1}}})).segments.size(), 1U);
  EXPECT_EQ(builder.non_finite_frames(), 1U);
}

TEST_F(FrameBuilderTest, TestsNothingAfterAGapOrATeleport) {
  FrameBuilder builder(avatar_, ids_);
  builder.next(frame_at(0, {{3, {0, 0, 0}}, {7, {0, 0, 0}}}));
  builder.next(frame_at(1, {{7, {0, 0, 1}}}));
  TraceFrame third = frame_at(2, {{3, {0, 0, 1}}, {7, {0, 0, 2}}});
  third.teleported = {7};
  EXPECT_TRUE(builder.next(third).segments.empty());
  EXPECT_EQ(builder.next(frame_at(3, {{3, {0, 0, 1}}, {7, {0, 0, 2}}})).segments.size(), 2U);
}

TEST_F(FrameBuilderTest, KnowsATeleportInWhateverOrderIdsComeAndPassesOverUnknownIds) {
  FrameBuilder builder(avatar_, ids_);
  const std::vector<ColliderSample> colliders = {{9, {0, 0, 0}}, {3, {0, 0, 0}}, {5, {0, 0, 0}}, {7, {0, 0, 0}}};
  builder.next(frame_at(0, colliders));
  TraceFrame second = frame_at(1, colliders);
  second.teleported = {100, 9, 5, 3, 9};
  const DetectorFrame& frame = builder.next(second);
  ASSERT_EQ(frame.segments.size(), 1U);
  EXPECT_EQ(frame.segments[0].column, 1U);
  EXPECT_EQ(builder.next(frame_at(2, colliders)).segments.size(), 3U);
}

TEST_F(FrameBuilderTest, TestsNothingAcrossFramesThatADamagedTraceLost) {
  FrameBuilder builder(avatar_, ids_);
  builder.next(frame_at(0, {{3, {0, 0, 0}}}));
  EXPECT_TRUE(builder.next(frame_at(5, {{3, {0, 0, 1}}})).segments.empty());
  EXPECT_EQ(builder.next(frame_at(6, {{3, {0, 0, 2}}})).segments.size(), 1U);
}

TEST_F(FrameBuilderTest, DropsAndCountsWhatIsNotFinite) {
  FrameBuilder builder(avatar_, ids_);
  builder.next(frame_at(0, {{3, {0, 0, 0}}, {7, {0, 0, 0}}}));
  EXPECT_EQ(builder.next(frame_at(1, {{3, {kNan, 0, 0}}, {7, {0, 0, 1}}})).segments.size(), 1U);
  EXPECT_EQ(builder.next(frame_at(2, {{3, {0, 0, 0}}, {7, {0, 0, 1}}})).segments.size(), 1U);
  EXPECT_EQ(builder.non_finite_segments(), 2U);
  TraceFrame bad_pose = frame_at(3, {{3, {0, 0, 0}}, {7, {0, 0, 1}}});
  bad_pose.poses.front().nodes[0].translation.x = std::numeric_limits<float>::infinity();
  EXPECT_TRUE(builder.next(bad_pose).segments.empty());
  EXPECT_EQ(builder.non_finite_frames(), 1U);
}

TEST_F(FrameBuilderTest, KeepsAWholeMetreOriginUntilTheAvatarIsTwoMetresAway) {
  FrameBuilder builder(avatar_, ids_);
  TraceFrame frame = frame_at(0, {});
  const auto origin_at = [&](double x) {
    ++frame.index;
    frame.poses.front().origin_m.x = x;
    return builder.next(frame).origin_m.x;
  };
  EXPECT_EQ(origin_at(0.25), 0);
  EXPECT_EQ(origin_at(2), 0);
  EXPECT_EQ(builder.origin_changes(), 0U);
  EXPECT_EQ(origin_at(2.25), 2);
  EXPECT_EQ(origin_at(0.5), 2);
  EXPECT_EQ(origin_at(-100.75), -101);
  EXPECT_EQ(builder.origin_changes(), 2U);
}

TEST_F(FrameBuilderTest, GivesTheSameBitsTenThousandKilometresAway) {
  FrameBuilder here(avatar_, ids_);
  FrameBuilder there(avatar_, ids_);
  const glm::dvec3 shift(1e7, -1e7, 3);
  for (std::uint64_t i = 0; i < 200; ++i) {
    const double x = std::ldexp(std::round(std::ldexp(0.0371 * static_cast<double>(i), 20)), -20);
    TraceFrame frame = frame_at(i, {{3, {x, 0.5, 1 - x}}});
    frame.poses.front().origin_m = {x, 0, 0};
    frame.poses.front().nodes[0].translation = {0.3F, 0.1F, -0.7F};
    TraceFrame shifted = frame;
    shifted.poses.front().origin_m += shift;
    shifted.colliders[0].position_m += shift;
    const DetectorFrame& a = here.next(frame);
    const DetectorFrame& b = there.next(shifted);
    EXPECT_EQ(a.origin_m + shift, b.origin_m);
    ASSERT_EQ(a.segments.size(), b.segments.size());
    if (!a.segments.empty()) {
      EXPECT_EQ(a.segments[0].start, b.segments[0].start);
      EXPECT_EQ(a.segments[0].end, b.segments[0].end);
    }
    for (std::size_t column = 0; column < 4; ++column)
      EXPECT_EQ(a.palette[0].column[column], b.palette[0].column[column]);
  }
}

}  // namespace
}  // namespace vestige
