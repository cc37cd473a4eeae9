#include "analysis/accuracy/event_score.hpp"

#include <algorithm>
#include <cmath>

namespace vestige {

namespace {

/// Frame times are rounded to nanoseconds, so events one test frame apart may seem this much farther apart.
constexpr double kTimeRounding_s = 1e-9;

using Events = std::span<const ContactEvent>;

/// Returns the events of one collider that meet `event`. They do not overlap, since a frame has at most one contact of
/// a collider. So their beginnings and their ends both ascend.
Events meeting(Events of_collider, const ContactEvent& event, double reach_s) {
  const auto first = std::ranges::lower_bound(of_collider, event.impact_s - reach_s, {}, &ContactEvent::last_s);
  const auto last = std::ranges::upper_bound(of_collider, event.last_s + reach_s, {}, &ContactEvent::impact_s);
  if (first >= last) return {};
  return {first, last};
}

bool has_actuator(Events events, std::uint16_t actuator) {
  return std::ranges::find(events, actuator, &ContactEvent::actuator) != events.end();
}

/// Returns the same events as if each ended at once.
std::vector<ContactEvent> impacts_of(Events events) {
  std::vector<ContactEvent> impacts(events.begin(), events.end());
  for (ContactEvent& event : impacts) event.last_s = event.impact_s;
  return impacts;
}

EventScore score(Events truth, Events test, std::size_t colliders, double rule_reach_s, double until_s) {
  const double reach_s = rule_reach_s + kTimeRounding_s;
  EventScore score;
  score.of_collider.resize(colliders);
  std::vector<bool> is_right;  // for each test event
  is_right.reserve(test.size());
  for (const ContactEvent& event : test) {
    EventCounts& counts = score.of_collider[event.column];
    const Events met = meeting(events_of(truth, event.column), event, reach_s);
    const ContactEvent* nearest = nullptr;
    for (const ContactEvent& one : met)
      if (one.actuator == event.actuator && (nearest == nullptr || std::abs(one.impact_s - event.impact_s) <
                                                                       std::abs(nearest->impact_s - event.impact_s)))
        nearest = &one;
    is_right.push_back(nearest != nullptr);
    if (nearest != nullptr) {
      ++counts.right;
      score.impact_error_s.push_back(std::abs(event.impact_s - nearest->impact_s));
      score.onset_error_s.push_back(std::abs(event.reported_s - nearest->impact_s));
    } else if (!met.empty()) {
      ++counts.wrong_actuator;
    } else {
      ++counts.false_events;
    }
  }
  for (const ContactEvent& event : truth) {
    if (event.impact_s > until_s) continue;
    EventCounts& counts = score.of_collider[event.column];
    const Events met = meeting(events_of(test, event.column), event, reach_s);
    const auto is_wrong = [&](const ContactEvent& one) {
      return !is_right[static_cast<std::size_t>(&one - test.data())];
    };
    if (has_actuator(met, event.actuator)) {
      ++counts.found;
    } else if (std::ranges::any_of(met, is_wrong)) {
      ++counts.mistaken;
    } else {
      ++counts.missed;
      if (!met.empty()) ++counts.missed_beside_another;
    }
  }
  for (const EventCounts& counts : score.of_collider) score.all += counts;
  return score;
}

}  // namespace

EventCounts& EventCounts::operator+=(const EventCounts& other) {
  found += other.found;
  mistaken += other.mistaken;
  missed += other.missed;
  missed_beside_another += other.missed_beside_another;
  right += other.right;
  wrong_actuator += other.wrong_actuator;
  false_events += other.false_events;
  return *this;
}

EventScore& EventScore::operator+=(const EventScore& other) {
  all += other.all;
  of_collider.insert(of_collider.end(), other.of_collider.begin(), other.of_collider.end());
  impact_error_s.insert(impact_error_s.end(), other.impact_error_s.begin(), other.impact_error_s.end());
  onset_error_s.insert(onset_error_s.end(), other.onset_error_s.begin(), other.onset_error_s.end());
  return *this;
}

EventScore score_events(Events truth, Events test, std::size_t colliders, const MatchRule& rule, double until_s) {
  if (rule.match == EventMatch::kOverlap) return score(truth, test, colliders, rule.reach_s, until_s);
  return score(impacts_of(truth), impacts_of(test), colliders, rule.reach_s, until_s);
}

}  // namespace vestige
