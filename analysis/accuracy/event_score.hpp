#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/accuracy/contact_events.hpp"

namespace vestige {

/// How well the events that a detector found agree with the true ones.
///
/// A test event and a true event of one collider meet if the times that they last, from impact to last instant, lie no
/// farther apart than one test frame; they match if they have the same actuator too. One test event may match several
/// true ones (what happens within a frame is one contact), and several may match one.
struct EventScore {
  // Each true event is one of these three.
  std::uint64_t found = 0;     ///< a test event matches it
  std::uint64_t mistaken = 0;  ///< none matches, but one that matches no other true event meets it
  std::uint64_t missed = 0;    ///< neither
  /// Of those missed: they meet a test event that is right about another true one. A row that held more than one
  /// contact for each collider could have shown them.
  std::uint64_t missed_beside_another = 0;

  // Each test event is one of these three.
  std::uint64_t right = 0;           ///< it matches a true event
  std::uint64_t wrong_actuator = 0;  ///< it meets true events, all of other actuators
  std::uint64_t false_events = 0;    ///< it meets none

  /// For each right test event, seconds: how far its impact, and how far the end of its first frame, when it is known,
  /// lie from the impact of the true event that it matches; of several, the one with the nearest impact.
  std::vector<double> impact_error_s;
  std::vector<double> onset_error_s;

  std::uint64_t true_events() const { return found + mistaken + missed; }
  std::uint64_t test_events() const { return right + wrong_actuator + false_events; }
  double missed_share() const;  ///< of the true events; 0 where there are none
};

/// Both as `ContactEventFinder::take` gives them. True events whose impact is later than `until_s`, where the test
/// ended, do not count, but may excuse a test event.
EventScore score_events(std::span<const ContactEvent> truth, std::span<const ContactEvent> test, double test_frame_s,
                        double until_s);

}  // namespace vestige
