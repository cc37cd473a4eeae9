#include "analysis/accuracy/event_score.hpp"

#include <algorithm>
#include <cmath>

namespace vestige {

namespace {

/// Frame times are rounded to nanoseconds, so events one test frame apart may seem this much farther apart.
constexpr double kTimeRounding_s = 1e-9;

using Events = std::span<const ContactEvent>;

Events of_column(Events events, std::uint32_t column) {
  return {std::ranges::lower_bound(events, column, {}, &ContactEvent::column),
          std::ranges::upper_bound(events, column, {}, &ContactEvent::column)};
}

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

}  // namespace

double EventScore::missed_share() const {
  return true_events() == 0 ? 0 : static_cast<double>(missed) / static_cast<double>(true_events());
}

EventScore score_events(Events truth, Events test, double test_frame_s, double until_s) {
  const double reach_s = test_frame_s + kTimeRounding_s;
  EventScore score;
  std::vector<bool> is_right;  // for each test event
  is_right.reserve(test.size());
  for (const ContactEvent& event : test) {
    const Events met = meeting(of_column(truth, event.column), event, reach_s);
    const ContactEvent* nearest = nullptr;
    for (const ContactEvent& one : met)
      if (one.actuator == event.actuator && (nearest == nullptr || std::abs(one.impact_s - event.impact_s) <
                                                                       std::abs(nearest->impact_s - event.impact_s)))
        nearest = &one;
    is_right.push_back(nearest != nullptr);
    if (nearest != nullptr) {
      ++score.right;
      score.impact_error_s.push_back(std::abs(event.impact_s - nearest->impact_s));
      score.onset_error_s.push_back(std::abs(event.reported_s - nearest->impact_s));
    } else if (!met.empty()) {
      ++score.wrong_actuator;
    } else {
      ++score.false_events;
    }
  }
  for (const ContactEvent& event : truth) {
    if (event.impact_s > until_s) continue;
    const Events met = meeting(of_column(test, event.column), event, reach_s);
    const auto is_wrong = [&](const ContactEvent& one) {
      return !is_right[static_cast<std::size_t>(&one - test.data())];
    };
    if (has_actuator(met, event.actuator)) {
      ++score.found;
    } else if (std::ranges::any_of(met, is_wrong)) {
      ++score.mistaken;
    } else {
      ++score.missed;
      if (!met.empty()) ++score.missed_beside_another;
    }
  }
  return score;
}

}  // namespace vestige
