#include "analysis/run/person_replay.hpp"

#include <algorithm>
#include <utility>

namespace vestige {

namespace {

void look_up_anew(const ActuatorMap& map, ContactRow& row) {
  for (Contact& contact : row)
    if (contact.hit()) contact.actuator = map.at(contact.triangle, contact.texture_coordinate);
}

}  // namespace

PersonReplay::PersonReplay(const ReplayPerson& plan, std::size_t person, const Detector& detector)
    : plan_(plan), person_(person), builder_(plan.avatar, {}, detector.method(), person, detector.skip()) {
  result_.contacts_of_actuator.resize(plan.actuator_count + 1);
}

void PersonReplay::check_skinning(const TraceFrame& frame, const DetectorFrame& built, Detector& detector) {
  const Pose& pose = frame.poses[person_];
  if (!pose.nodes.empty()) result_.skinning.add(plan_.avatar, pose, built, detector);
}

void PersonReplay::take(const DetectorFrame& frame, ContactRow& row, ContactRow* other,
                        std::span<const std::uint32_t> ids) {
  follow_map_changes(frame.time_s);
  if (changed_map_ != nullptr) {
    look_up_anew(*changed_map_, row);
    if (other != nullptr) look_up_anew(*changed_map_, *other);
  }
  for (const Contact& contact : std::as_const(row)) {
    if (!contact.hit()) continue;
    ++result_.contacts;
    ++result_.contacts_of_actuator[contact.actuator];
  }
  hash_.add(row);
  contacts_hash_.add(frame.index, row, ids);
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

PersonResult PersonReplay::finish() {
  result_.texture_hash = hash_.hex();
  result_.contacts_hash = contacts_hash_.hex();
  result_.origin_changes = builder_.origin_changes();
  result_.non_finite_frames = builder_.non_finite_frames();
  result_.non_finite_segments = builder_.non_finite_segments();
  result_.first_non_finite = builder_.first_non_finite();
  return std::move(result_);
}

}  // namespace vestige
