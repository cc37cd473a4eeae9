#include "analysis/run/person_replay.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace vestige {

namespace {

void look_up_anew(const ActuatorMap& map, ContactRow& row) {
  for (Contact& contact : row)
    if (contact.hit()) contact.actuator = map.at(contact.triangle, contact.texture_coordinate);
}

}  // namespace

RecordedRows::RecordedRows(std::span<const RecordedContact> contacts, std::uint16_t avatar,
                           std::span<const std::uint32_t> collider_ids)
    : collider_ids_(collider_ids) {
  std::ranges::copy_if(contacts, std::back_inserter(contacts_),
                       [&](const RecordedContact& contact) { return contact.avatar == avatar; });
}

const ContactRow& RecordedRows::row_of(std::uint64_t frame) {
  row_.clear(collider_ids_.size());
  for (; next_ < contacts_.size() && contacts_[next_].frame <= frame; ++next_) {
    const RecordedContact& recorded = contacts_[next_];
    const auto place = std::ranges::lower_bound(collider_ids_, recorded.collider);
    if (recorded.frame < frame || place == collider_ids_.end() || *place != recorded.collider) {
      ++strangers_;
      continue;
    }
    Contact& contact = row_[static_cast<std::size_t>(place - collider_ids_.begin())];
    contact.triangle = recorded.triangle;
    contact.t = recorded.t;
    contact.actuator = recorded.actuator;
  }
  return row_;
}

PersonReplay::PersonReplay(const ReplayPerson& plan, std::size_t person, std::span<const std::uint32_t> collider_ids,
                           const Detector& detector, const std::vector<RecordedContact>* expected)
    : plan_(plan), builder_(plan.avatar, collider_ids, detector.method(), person, detector.skip()) {
  result_.contacts_of_actuator.resize(plan.actuator_count + 1);
  if (expected != nullptr) recorded_.emplace(*expected, static_cast<std::uint16_t>(person + 1), collider_ids);
}

void PersonReplay::take(const DetectorFrame& frame, ContactRow& row, ContactRow* other, Comparison* comparison) {
  follow_map_changes(frame.time_s);
  if (changed_map_ != nullptr) {
    look_up_anew(*changed_map_, row);
    if (other != nullptr) look_up_anew(*changed_map_, *other);
  }
  if (other != nullptr) comparison->add(row, *other);
  if (recorded_) comparison->add(row, recorded_->row_of(frame.index));
  for (const Contact& contact : std::as_const(row)) {
    if (!contact.hit()) continue;
    ++result_.contacts;
    ++result_.contacts_of_actuator[contact.actuator];
  }
  hash_.add(row);
  if (plan_.timeline == nullptr) return;
  const ActuatorFrame& driven = plan_.drive->next(frame.time_s, row, &frame);
  result_.any_vibrates |= std::ranges::any_of(driven.duty, [](std::uint8_t duty) { return duty != 0; });
  plan_.timeline->write(driven);
}

void PersonReplay::follow_map_changes(double time_s) {
  for (; result_.map_changes < plan_.changes.size(); ++result_.map_changes) {
    const MapChange& change = plan_.changes[result_.map_changes];
    if (change.time_s > time_s) return;
    changed_map_ = &change.map;
    if (plan_.drive != nullptr) plan_.drive->law().change_map(change.map.firing, change.layout);
  }
}

PersonResult PersonReplay::finish(bool interrupted, Comparison* comparison) {
  if (recorded_ && !interrupted) {
    comparison->missing += recorded_->strangers();
    comparison->expected += recorded_->strangers();
  }
  result_.texture_hash = hash_.hex();
  result_.origin_changes = builder_.origin_changes();
  result_.non_finite_frames = builder_.non_finite_frames();
  result_.non_finite_segments = builder_.non_finite_segments();
  result_.first_non_finite = builder_.first_non_finite();
  return std::move(result_);
}

}  // namespace vestige
