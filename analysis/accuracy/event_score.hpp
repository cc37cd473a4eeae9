#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/accuracy/contact_events.hpp"

namespace vestige {

/// How well the events that a detector found agree with the true ones.
///
/// A test event and a true event of the same collider meet if the gap between the two is at most one test frame. An
/// event lasts from its impact to its last instant. The two match if they also have the same actuator. One test event
/// may match several true events, since a row reports what happens within a frame as one contact. Several test events
/// may match one true event.
struct EventScore {
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

  /// For each right test event, in seconds: the distance of the test event's impact, and of the end of its first frame
  /// (when the impact is known), from the impact of the true event that it matches. If it matches several true events,
  /// the one with the nearest impact counts.
  std::vector<double> impact_error_s;
  std::vector<double> onset_error_s;

  std::uint64_t true_events() const { return found + mistaken + missed; }
  std::uint64_t test_events() const { return right + wrong_actuator + false_events; }
  double missed_share() const;  ///< share of the true events; 0 if there are no true events
};

/// Scores `test` against `truth`. Both are in the order of `ContactEventFinder::take`. The test ended at `until_s`:
/// true events with a later impact are not counted, but a test event that meets them is not a false event.
EventScore score_events(std::span<const ContactEvent> truth, std::span<const ContactEvent> test, double test_frame_s,
                        double until_s);

}  // namespace vestige
