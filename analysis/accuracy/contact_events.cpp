#include "analysis/accuracy/contact_events.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace vestige {

namespace {

void sort_events(std::vector<ContactEvent>& events) {
  std::ranges::sort(events, [](const ContactEvent& a, const ContactEvent& b) {
    return std::tie(a.column, a.first_frame) < std::tie(b.column, b.first_frame);
  });
}

bool goes_on(const ContactEvent& event, const ContactEvent& next) {
  return event.column == next.column && event.actuator == next.actuator && event.last_frame + 1 == next.first_frame;
}

}  // namespace

void ContactEventFinder::add(const DetectorFrame& frame, const ContactRow& row) {
  open_.resize(row.size());
  for (std::size_t column = 0; column < row.size(); ++column) {
    const Contact& contact = row[column];
    if (!contact.hit()) continue;
    ++contacts_;
    const double instant_s = frame.time_s - frame.duration_s * (1 - static_cast<double>(contact.t));
    const ContactEvent now = {static_cast<std::uint32_t>(column),
                              contact.actuator,
                              frame.index,
                              frame.index,
                              instant_s,
                              instant_s,
                              frame.time_s};
    std::optional<ContactEvent>& event = open_[column];
    if (event && goes_on(*event, now)) {
      event->last_frame = now.last_frame;
      event->last_s = now.last_s;
    } else {
      if (event) ended_.push_back(*event);
      event = now;
    }
  }
}

std::vector<ContactEvent> ContactEventFinder::take() {
  for (const std::optional<ContactEvent>& event : std::exchange(open_, {}))
    if (event) ended_.push_back(*event);
  sort_events(ended_);
  return std::exchange(ended_, {});
}

std::span<const ContactEvent> events_of(std::span<const ContactEvent> events, std::uint32_t column) {
  return {std::ranges::lower_bound(events, column, {}, &ContactEvent::column),
          std::ranges::upper_bound(events, column, {}, &ContactEvent::column)};
}

std::vector<ContactEvent> join_events(std::span<const std::vector<ContactEvent>> parts) {
  std::vector<ContactEvent> all;
  for (const std::vector<ContactEvent>& part : parts) all.insert(all.end(), part.begin(), part.end());
  sort_events(all);
  std::vector<ContactEvent> joined;
  joined.reserve(all.size());
  for (const ContactEvent& event : all) {
    if (!joined.empty() && goes_on(joined.back(), event)) {
      joined.back().last_frame = event.last_frame;
      joined.back().last_s = event.last_s;
    } else {
      joined.push_back(event);
    }
  }
  return joined;
}

}  // namespace vestige
