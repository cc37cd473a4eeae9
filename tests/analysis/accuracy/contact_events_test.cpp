// Events and their scores from sequences of contacts made by hand.

#include "analysis/accuracy/contact_events.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "analysis/accuracy/event_score.hpp"

namespace vestige {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr double kFrame_s = 0.01;
constexpr double kClose_s = 1e-12;
constexpr int kNone = -1;

/// One collider; for each frame the actuator that it touches at the frame's middle, or kNone.
std::vector<ContactEvent> events_of(const std::vector<int>& actuators, std::uint64_t first_frame = 1) {
  ContactEventFinder finder;
  DetectorFrame frame;
  frame.duration_s = kFrame_s;
  for (std::size_t i = 0; i < actuators.size(); ++i) {
    frame.index = first_frame + i;
    frame.time_s = static_cast<double>(frame.index) * kFrame_s;
    ContactRow row(1);
    if (actuators[i] != kNone) {
      row[0].triangle = 7;
      row[0].t = 0.5F;
      row[0].actuator = static_cast<std::uint16_t>(actuators[i]);
    }
    finder.add(frame, row);
  }
  return finder.take();
}

/// A contact of column 0 that lasts from one instant to another.
ContactEvent event(double impact_s, double last_s, std::uint16_t actuator = 1) {
  ContactEvent made;
  made.actuator = actuator;
  made.impact_s = impact_s;
  made.last_s = last_s;
  made.reported_s = impact_s + kFrame_s / 2;
  return made;
}

EventScore score(const std::vector<ContactEvent>& truth, const std::vector<ContactEvent>& test) {
  return score_events(truth, test, 2, {EventMatch::kOverlap, kFrame_s}, 1);
}

TEST(ContactEvents, FramesThatFollowEachOtherWithOneActuatorAreOneEvent) {
  const auto events = events_of({kNone, 3, 3, 3, kNone});
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events[0].actuator, 3);
  EXPECT_EQ(events[0].first_frame, 2U);
  EXPECT_EQ(events[0].last_frame, 4U);
  EXPECT_THAT(events[0].impact_s, DoubleNear(0.015, kClose_s));
  EXPECT_THAT(events[0].last_s, DoubleNear(0.035, kClose_s));
  EXPECT_THAT(events[0].reported_s, DoubleNear(0.02, kClose_s));
}

TEST(ContactEvents, AGapOfOneFrameAndAnotherActuatorEachEndAnEvent) {
  const auto events = events_of({3, kNone, 3, 4, 4, 0});
  std::vector<int> actuators;
  actuators.reserve(events.size());
  for (const ContactEvent& one : events) actuators.push_back(one.actuator);
  EXPECT_THAT(actuators, ElementsAre(3, 3, 4, 0));
}

TEST(ContactEvents, CollidersDoNotShareEvents) {
  ContactEventFinder finder;
  DetectorFrame frame;
  frame.index = 5;
  Contact contact;
  contact.triangle = 1;
  contact.t = 0;
  finder.add(frame, {contact, Contact(), contact});
  EXPECT_EQ(finder.contacts(), 2U);
  const auto events = finder.take();
  ASSERT_EQ(events.size(), 2U);
  EXPECT_EQ(events[0].column, 0U);
  EXPECT_EQ(events[1].column, 2U);
}

TEST(ContactEvents, PartsOfATraceJoinedAreTheEventsOfTheWhole) {
  const std::vector<int> whole = {kNone, 3, 3, 3, kNone, 4, 4, 5, kNone, 5};
  for (std::size_t cut = 0; cut <= whole.size(); ++cut) {
    const auto middle = whole.begin() + static_cast<std::ptrdiff_t>(cut);
    const std::vector<std::vector<ContactEvent>> parts = {events_of({whole.begin(), middle}),
                                                          events_of({middle, whole.end()}, 1 + cut)};
    EXPECT_EQ(join_events(parts), events_of(whole)) << "cut before frame " << cut;
  }
}

TEST(EventScore, WhatIsSeenAsItWasHasNoError) {
  const auto truth = events_of({1, kNone, 2, 2});
  const EventScore same = score(truth, truth);
  EXPECT_EQ(same.all.found, 2U);
  EXPECT_EQ(same.all.right, 2U);
  EXPECT_EQ(same.all.missed + same.all.mistaken + same.all.wrong_actuator + same.all.false_events, 0U);
  EXPECT_THAT(same.impact_error_s, ElementsAre(0, 0));
  EXPECT_THAT(same.onset_error_s, ElementsAre(DoubleNear(0.005, kClose_s), DoubleNear(0.005, kClose_s)));
}

TEST(EventScore, WhatNobodySawIsMissedAndWhatNeverWasIsFalse) {
  const EventScore nothing = score({event(0.2, 0.2)}, {});
  EXPECT_EQ(nothing.all.missed, 1U);
  const EventScore ghost = score({}, {event(0.2, 0.2)});
  EXPECT_EQ(ghost.all.false_events, 1U);
}

TEST(EventScore, EventsMeetUpToOneTestFrameApart) {
  EXPECT_EQ(score({event(0.2, 0.3)}, {event(0.31, 0.31)}).all.found, 1U);
  EXPECT_EQ(score({event(0.2, 0.3)}, {event(0.3101, 0.3101)}).all.missed, 1U);
  EXPECT_EQ(score({event(0.2, 0.3)}, {event(0.19, 0.19)}).all.found, 1U);
  EXPECT_EQ(score({event(0.2, 0.3)}, {event(0.1899, 0.1899)}).all.missed, 1U);
}

TEST(EventScore, ByImpactEventsMeetUpToTheToleranceApartHoweverLongTheyLast) {
  const auto found = [](const ContactEvent& truth, const ContactEvent& test) {
    return score_events(std::vector{truth}, std::vector{test}, 1, {EventMatch::kImpact, 0.02}, 1).all.found;
  };
  EXPECT_EQ(found(event(0.2, 0.3), event(0.22, 0.22)), 1U);
  EXPECT_EQ(found(event(0.2, 0.3), event(0.23, 0.3)), 0U);
  EXPECT_EQ(found(event(0.2, 0.2), event(0.18, 0.5)), 1U);
}

TEST(EventScore, SumsWhatEachColliderHas) {
  ContactEvent other = event(0.4, 0.4);
  other.column = 1;
  EventScore sum = score({event(0.2, 0.2), other}, {event(0.2, 0.2)});
  EXPECT_EQ(sum.of_collider[0].found, 1U);
  EXPECT_EQ(sum.of_collider[1].missed, 1U);
  EXPECT_EQ(sum.all.wrong(), 1U);
  sum += score({}, {other});
  EXPECT_EQ(sum.of_collider.size(), 4U);
  EXPECT_EQ(sum.of_collider[3].false_events, 1U);
  EXPECT_EQ(sum.all.wrong(), 2U);
}

TEST(EventScore, AnotherActuatorInItsPlaceIsAMistakeNotAMiss) {
  const EventScore wrong = score({event(0.2, 0.2, 1)}, {event(0.201, 0.201, 2)});
  EXPECT_EQ(wrong.all.mistaken, 1U);
  EXPECT_EQ(wrong.all.wrong_actuator, 1U);
  EXPECT_EQ(wrong.all.missed + wrong.all.found + wrong.all.false_events, 0U);
  EXPECT_THAT(wrong.impact_error_s, IsEmpty());
}

TEST(EventScore, OneContactOfAFrameThatHadTwoMissesTheOther) {
  const EventScore one_of_two = score({event(0.2, 0.2, 1), event(0.204, 0.204, 2)}, {event(0.2, 0.2, 1)});
  EXPECT_EQ(one_of_two.all.found, 1U);
  EXPECT_EQ(one_of_two.all.missed, 1U);
  EXPECT_EQ(one_of_two.all.missed_beside_another, 1U);
  EXPECT_EQ(one_of_two.all.wrong_actuator, 0U);
}

TEST(EventScore, OneTestEventCoversEveryTrueOneOfItsActuatorAndIsMeasuredByTheNearest) {
  const EventScore covered = score({event(0.195, 0.195), event(0.202, 0.202)}, {event(0.203, 0.203)});
  EXPECT_EQ(covered.all.found, 2U);
  EXPECT_EQ(covered.all.right, 1U);
  EXPECT_THAT(covered.impact_error_s, ElementsAre(DoubleNear(0.001, kClose_s)));
}

TEST(EventScore, CollidersAreNotMistakenForEachOther) {
  ContactEvent other = event(0.2, 0.2);
  other.column = 1;
  const EventScore apart = score({event(0.2, 0.2)}, {other});
  EXPECT_EQ(apart.all.missed, 1U);
  EXPECT_EQ(apart.all.false_events, 1U);
}

TEST(EventScore, WhatHappensAfterTheTestEndedDoesNotCount) {
  const std::vector<ContactEvent> truth = {event(0.2, 0.2), event(0.9, 0.9)};
  EXPECT_EQ(score_events(truth, {}, 2, {EventMatch::kOverlap, kFrame_s}, 0.5).all.missed, 1U);
}

}  // namespace
}  // namespace vestige
