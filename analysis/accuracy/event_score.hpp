#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/accuracy/contact_events.hpp"

namespace vestige {

/// How well the events that a detector found agree with the true ones.
///
/// A test event and a true event of the same collider meet by a `MatchRule`: by default, if the gap between the two is
/// at most its reach. An event lasts from its impact to its last instant. The two match if they also have the same
/// actuator. One test event may match several true events, since a row reports what happens within a frame as one
/// contact. Several test events may match one true event.
struct EventCounts {
  // Each true event is one of these three.
  std::uint64_t found = 0;  ///< at least one test event matches it
  /// No test event matches it, but one that matches no true event meets it.
  std::uint64_t mistaken = 0;
  std::uint64_t missed = 0;  ///< neither found nor mistaken
  /// The missed events that meet a test event which is right about another true event. A row with room for more than
  /// one contact of a collider could have shown them.
  std::uint64_t missed_beside_another = 0;

  // Each test event is one of these three.
  std::uint64_t right = 0;           ///< it matches a true event
  std::uint64_t wrong_actuator = 0;  ///< it meets true events, but all of them have other actuators
  std::uint64_t false_events = 0;    ///< it meets no true event

  std::uint64_t true_events() const { return found + mistaken + missed; }
  std::uint64_t test_events() const { return right + wrong_actuator + false_events; }
  /// What a user would feel or miss: true events without a vibration, and vibrations without a true event, or of
  /// another actuator.
  std::uint64_t wrong() const { return missed + wrong_actuator + false_events; }

  EventCounts& operator+=(const EventCounts& other);
};

/// How well all events of a scene agree.
struct EventScore {
  EventCounts all;
  /// One for each collider. The events of one collider depend on each other, those of different ones hardly do.
  std::vector<EventCounts> of_collider;

  /// For each right test event, in seconds: the distance of the test event's impact, and of the end of its first frame
  /// (when the impact is known), from the impact of the true event that it matches. If it matches several true events,
  /// the one with the nearest impact counts.
  std::vector<double> impact_error_s;
  std::vector<double> onset_error_s;

  /// Adds the score of the same scene with other colliders.
  EventScore& operator+=(const EventScore& other);
};

/// When a test event and a true event meet.
enum class EventMatch {
  kOverlap,  ///< their times, extended by the reach, overlap
  kImpact,   ///< their impacts are no farther apart than the reach
};

/// What an event that was found is compared by.
struct MatchRule {
  EventMatch match = EventMatch::kOverlap;
  double reach_s = 0;
};

/// Scores `test` against `truth`. Both are in the order of `ContactEventFinder::take`, and their columns are below
/// `colliders`. The test ended at `until_s`: true events with a later impact are not counted, but a test event that
/// meets them is not a false event.
EventScore score_events(std::span<const ContactEvent> truth, std::span<const ContactEvent> test, std::size_t colliders,
                        const MatchRule& rule, double until_s);

}  // namespace vestige
