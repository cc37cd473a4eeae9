// Live input as whole frames.

#include "traces/live/live_state.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <limits>

#include "tests/support/builtin_avatar.hpp"
#include "tests/support/osc.hpp"
#include "traces/live/live_scene.hpp"

namespace vestige {
namespace {

using namespace std::chrono_literals;
using test::bone;
using test::bundle;
using test::collider;
using test::placement;
using test::with_id;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

using Bytes = std::vector<std::byte>;

const glm::dquat kNoTurn(1, 0, 0, 0);

Bytes root_at(double x) {
  return placement("/VMC/Ext/Root/Pos", "root", {x, 0, 0}, kNoTurn);
}

Bytes end_of_frame(std::int32_t value = 1) {
  return with_id("/VMC/Ext/OK", value);
}

UdpAddress address(int number) {
  UdpAddress address;
  address.bytes.front() = static_cast<std::byte>(number);
  return address;
}

class WholeFrames : public ::testing::Test {
 protected:
  /// Takes a datagram, a millisecond after the one before.
  bool take(const Bytes& bytes, LiveState& state, int sender = 1) {
    time_ += 1ms;
    return state.take({.bytes = bytes, .arrived = time_, .sender = address(sender)});
  }
  bool take(const Bytes& bytes) { return take(bytes, state_); }

  TraceFrame shown(LiveState& state) const {
    TraceFrame frame;
    state.show(frame);
    return frame;
  }
  TraceFrame shown() { return shown(state_); }

  /// Where the root of a frame is. VMC's x is mirrored.
  double root_x(const TraceFrame& frame) const {
    const Pose rest = rest_pose(avatar_);
    for (std::size_t i = 0; i < rest.nodes.size(); ++i) {
      const double moved = double{rest.nodes[i].translation.x} - double{frame.poses[0].nodes[i].translation.x};
      if (moved != 0) return moved;
    }
    return 0;
  }

  static std::vector<std::uint32_t> ids_of(const TraceFrame& frame) {
    std::vector<std::uint32_t> ids;
    for (const ColliderSample& one : frame.colliders) ids.push_back(one.id);
    return ids;
  }

  const Avatar avatar_ = test::builtin_avatar();
  LiveState state_{avatar_, glm::dvec3(0)};
  LiveState::Clock::time_point time_{};
};

TEST_F(WholeFrames, EachDatagramIsOneUnlessTheSenderSaysWhereTheyEnd) {
  EXPECT_TRUE(take(collider(3, 1, 2, 3)));
  EXPECT_FALSE(take(root_at(1))) << "more of it may come";
  time_ += 10ms;
  EXPECT_TRUE(take(root_at(2))) << "none came, and no end";
  EXPECT_NEAR(root_x(shown()), 2, 1e-6);
  EXPECT_TRUE(take(root_at(3)));
  EXPECT_NEAR(root_x(shown()), 3, 1e-6);
  EXPECT_FALSE(take(with_id("/somebody/else", 1))) << "says nothing";
  EXPECT_EQ(state_.frames(), 4U);
  EXPECT_EQ(state_.poses(), 3U);
  EXPECT_EQ(state_.pose_arrived(), LiveState::Clock::time_point(14ms));
}

TEST_F(WholeFrames, ASteadySenderThatNeverSaysAnEndIsShownAfterATenthOfASecond) {
  int first = 0;
  while (first < 200 && !take(root_at(first))) ++first;
  EXPECT_EQ(first, 101);
  for (int i = 0; i < 50; ++i) EXPECT_TRUE(take(root_at(i)));
  EXPECT_TRUE(take(bundle({root_at(1), end_of_frame()}))) << "now it does";
  EXPECT_TRUE(state_.take_beginning());
  EXPECT_FALSE(take(root_at(2)));
}

TEST_F(WholeFrames, AFrameOfSeveralDatagramsIsNotShownHalfTold) {
  EXPECT_FALSE(take(end_of_frame(0))) << "there is no frame yet";
  EXPECT_FALSE(take(root_at(1)));
  EXPECT_FALSE(take(collider(3, 1, 2, 3)));
  EXPECT_EQ(root_x(shown()), 0);
  EXPECT_THAT(ids_of(shown()), IsEmpty());
  EXPECT_TRUE(take(end_of_frame()));
  EXPECT_NEAR(root_x(shown()), 1, 1e-6);
  EXPECT_THAT(ids_of(shown()), ElementsAre(3U));
  EXPECT_FALSE(take(bundle({root_at(2), collider(4, 0, 0, 0)})));
  EXPECT_NEAR(root_x(shown()), 1, 1e-6) << "the frame before stays";
  EXPECT_THAT(ids_of(shown()), ElementsAre(3U));
  EXPECT_TRUE(take(bundle({bone("Head", kNoTurn), end_of_frame()})));
  EXPECT_NEAR(root_x(shown()), 2, 1e-6);
  EXPECT_EQ(state_.frames(), 2U);
  EXPECT_EQ(state_.arrived(), time_);
}

TEST_F(WholeFrames, CollidersBetweenPosesAreFramesOfTheirOwn) {
  take(bundle({root_at(1), end_of_frame()}));
  EXPECT_TRUE(take(collider(3, 1, 2, 3)));
  EXPECT_THAT(ids_of(shown()), ElementsAre(3U));
  take(bundle({root_at(1.1), end_of_frame()}));
  EXPECT_EQ(state_.frames(), 3U);
  EXPECT_EQ(state_.poses(), 2U);
}

TEST_F(WholeFrames, ALostEndHoldsNothingUpForLong) {
  take(bundle({root_at(1), end_of_frame()}));
  EXPECT_FALSE(take(root_at(2)));
  EXPECT_FALSE(take(collider(3, 1, 2, 3)));
  time_ += 10ms;
  EXPECT_TRUE(take(root_at(3))) << "ends the pose before";
  EXPECT_NEAR(root_x(shown()), 2, 1e-6) << "and is not whole itself";
  EXPECT_THAT(ids_of(shown()), ElementsAre(3U));
  EXPECT_EQ(state_.pose_arrived(), LiveState::Clock::time_point(2ms)) << "it had arrived when it was told";
  time_ += 10ms;
  EXPECT_TRUE(take(collider(3, 1, 2, 4)));
  EXPECT_NEAR(root_x(shown()), 3, 1e-6);
  EXPECT_EQ(state_.frames(), 4U);
}

TEST_F(WholeFrames, ATeleportOfAFrameThatNobodySawIsNotLost) {
  take(bundle({root_at(1), collider(3, 1, 2, 3), end_of_frame()}));
  shown();
  take(bundle({collider(3, 5, 2, 3), with_id("/vestige/teleport", 3)}));
  take(root_at(1.1));
  EXPECT_FALSE(take(with_id("/vestige/teleport", 3))) << "no frame of its own: it waits for the position";
  EXPECT_THAT(shown().teleported, ElementsAre(3U)) << "of the whole frame";
  EXPECT_THAT(shown().teleported, IsEmpty()) << "once";
  take(end_of_frame());
  EXPECT_THAT(shown().teleported, ElementsAre(3U)) << "of the frame that was told in part";
  state_.mark_teleported(std::vector<std::uint32_t>{3, 7});
  EXPECT_THAT(shown().teleported, ElementsAre(3U, 7U));
}

TEST_F(WholeFrames, NoMotionLeadsToTheFirstPoseAndToTheFirstWholeOne) {
  take(collider(3, 1, 2, 3));
  EXPECT_FALSE(state_.take_beginning());
  take(root_at(1));
  time_ += 10ms;
  take(root_at(1));
  EXPECT_TRUE(state_.take_beginning());
  EXPECT_FALSE(state_.take_beginning());
  take(bundle({root_at(1), end_of_frame()}));
  EXPECT_TRUE(state_.take_beginning()) << "what was shown before may have been half-told";
  take(bundle({root_at(1), end_of_frame()}));
  EXPECT_FALSE(state_.take_beginning());
}

TEST_F(WholeFrames, OfSeveralSendersTheFirstIsHeardUntilItIsSilent) {
  LiveState state(avatar_, glm::dvec3(0), {}, LiveState::Senders::kOneAtATime);
  EXPECT_FALSE(take(end_of_frame(0), state, 2)) << "asks whether somebody listens, and says nothing yet";
  EXPECT_TRUE(take(bundle({root_at(1), end_of_frame()}), state, 1));
  EXPECT_FALSE(take(root_at(2), state, 2));
  EXPECT_NEAR(root_x(shown(state)), 1, 1e-6);
  EXPECT_TRUE(take(collider(3, 1, 2, 3), state, 2)) << "one program may send the pose, and another colliders";
  EXPECT_FALSE(take(collider(4, 1, 2, 3), state, 1));
  EXPECT_EQ(state.left_out(), 2U);
  EXPECT_EQ(state.stranger(), address(2));
  time_ += 1001ms;
  EXPECT_TRUE(take(bundle({root_at(2), end_of_frame()}), state, 2));
  EXPECT_FALSE(take(bundle({root_at(1), end_of_frame()}), state, 1));
  EXPECT_TRUE(take(bundle({root_at(3), end_of_frame()}), state_, 1));
  EXPECT_TRUE(take(bundle({root_at(4), end_of_frame()}), state_, 2)) << "a state that hears everybody";
}

TEST_F(WholeFrames, WhereFramesEndIsForgottenWithTheSender) {
  LiveState state(avatar_, glm::dvec3(0), {}, LiveState::Senders::kOneAtATime);
  take(bundle({root_at(1), end_of_frame()}), state, 1);
  EXPECT_FALSE(take(root_at(2), state, 1));
  time_ += 1001ms;
  EXPECT_TRUE(take(root_at(3), state, 2)) << "it has not said that its frames have ends";
  EXPECT_NEAR(root_x(shown(state)), 3, 1e-6);
}

TEST_F(WholeFrames, ADatagramThatIsLeftOutTakesNoPlaceAndAMarkerNeedsNone) {
  LiveState state(avatar_, glm::dvec3(0), {}, LiveState::Senders::kOneAtATime);
  take(collider(3, 1, 2, 3), state, 1);
  EXPECT_FALSE(take(bundle({root_at(1), collider(3, 4, 5, 6)}), state, 2));
  EXPECT_TRUE(take(bundle({root_at(2), end_of_frame()}), state, 3)) << "nobody sends poses yet";
  take(test::marker("here"), state, 4);
  EXPECT_EQ(state.vmc().markers().size(), 1U);
  EXPECT_EQ(state.left_out(), 1U);
}

TEST_F(WholeFrames, CollidersOfAProgramThatFellSilentAreGone) {
  LiveState state(avatar_, glm::dvec3(0), {}, LiveState::Senders::kOneAtATime);
  take(collider(3, 1, 2, 3), state, 2);
  const auto heard = time_;
  take(root_at(1), state, 1);
  EXPECT_FALSE(state.remove_colliders_silent_since(heard - 1ms));
  EXPECT_TRUE(state.remove_colliders_silent_since(heard));
  EXPECT_FALSE(state.remove_colliders_silent_since(heard)) << "once";
  EXPECT_THAT(ids_of(shown(state)), IsEmpty());
  take(collider(4, 1, 2, 3), state, 1);
  EXPECT_FALSE(state.remove_colliders_silent_since(time_)) << "whoever sends poses may leave colliders where they are";
}

TEST_F(WholeFrames, ACollidersWayAcrossItsAbsenceIsNoMotion) {
  take(collider(3, 1, 2, 3));
  shown();
  take(bundle({with_id("/vestige/collider/remove", 3), collider(3, -1, 2, 3)}));
  EXPECT_THAT(shown().teleported, ElementsAre(3U)) << "it was gone in between, though nobody saw that";
  take(with_id("/vestige/collider/remove", 3));
  EXPECT_THAT(ids_of(shown()), IsEmpty());
  take(collider(3, 1, 2, 3));
  EXPECT_THAT(shown().teleported, IsEmpty()) << "all saw that";
}

TEST_F(WholeFrames, WhatCannotBeReadChangesNothing) {
  take(bundle({root_at(1), end_of_frame()}));
  EXPECT_FALSE(take(bundle({root_at(std::numeric_limits<double>::quiet_NaN()), end_of_frame()})));
  EXPECT_FALSE(take(Bytes(7, std::byte{1})));
  EXPECT_EQ(state_.vmc().malformed(), 2U);
  EXPECT_EQ(state_.frames(), 1U);
  EXPECT_NEAR(root_x(shown()), 1, 1e-6);
}

TEST_F(WholeFrames, OfSeveralSourcesBecomeOneScene) {
  LiveState other(avatar_, glm::dvec3(0));
  LiveScene scene({&state_, &other});
  take(collider(3, 1, 2, 3));
  TraceFrame frame;
  scene.show(frame);
  take(bundle({collider(3, 9, 9, 9), collider(2, 4, 5, 6), with_id("/vestige/teleport", 2)}), other);
  const auto teleported = scene.show(frame);
  EXPECT_THAT(ids_of(frame), ElementsAre(2U, 3U));
  EXPECT_EQ(frame.colliders[1].position_m, glm::dvec3(1, 2, 3)) << "of whoever sent it first";
  EXPECT_EQ(frame.poses.size(), 2U);
  EXPECT_THAT(frame.teleported, ElementsAre(2U));
  EXPECT_THAT(teleported, ElementsAre(IsEmpty(), ElementsAre(2U)));
  EXPECT_TRUE(scene.ids_clash());
  take(with_id("/vestige/collider/remove", 3));
  scene.show(frame);
  EXPECT_EQ(frame.colliders[1].position_m, glm::dvec3(9, 9, 9)) << "whoever sent it first has given it up";
}

}  // namespace
}  // namespace vestige
