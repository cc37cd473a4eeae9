#include "analysis/plot/film/felt_trace.hpp"

#include <utility>

#include "detector/depth/depth_detector.hpp"
#include "detector/detectors/make_detectors.hpp"

namespace vestige::plot {

namespace {

std::unique_ptr<Detector> make_detector(const Subject& person, PlaneSet planes, Method method) {
  DetectorOptions options;
  options.planes = planes;
  options.method = method;
  options.skip = Skip::kOn;
  std::unique_ptr<Detector> detector = make_cpu_detector(person.avatar, person.map, options);
  return planes.has(Plane::kDepth) ? with_depth(std::move(detector), person.avatar) : std::move(detector);
}

}  // namespace

FeltTrace::FeltTrace(TraceReader& trace, const std::vector<Subject>& people, const LawFlags& law, Method method)
    : trace_(trace), people_(people), ids_(trace.collider_ids()), makers_(people.size()), drives_(people.size()) {
  for (std::size_t i = 0; i < people.size(); ++i) {
    const Subject& person = people[i];
    PlaneSet planes = kHashedPlanes | Plane::kBarycentric;
    if (person.map.actuator_count > 0) planes = planes | makers_[i].emplace(law, person.avatar, person.map).planes();
    detectors_.push_back(make_detector(person, planes, method));
  }
  rewind();
}

void FeltTrace::rewind() {
  trace_.rewind();
  std::vector<DetectedPerson> detected;
  for (std::size_t i = 0; i < people_.size(); ++i) {
    detected.push_back({i, people_[i].avatar, *detectors_[i]});
    if (makers_[i]) drives_[i] = makers_[i]->make();
  }
  run_.emplace(detected, ids_);
}

bool FeltTrace::next() {
  if (!trace_.next(frame_)) return false;
  run_->step(frame_);
  contacts_.clear();
  duty_.clear();
  for (std::size_t i = 0; i < people_.size(); ++i) {
    note_contacts(i);
    if (!drives_[i]) continue;
    const ActuatorFrame& felt = drives_[i]->next(frame_.time_s(), run_->row(i), &run_->frame(i));
    duty_.insert(duty_.end(), felt.duty.begin(), felt.duty.end());
  }
  return true;
}

void FeltTrace::note_contacts(std::size_t person) {
  const ContactRow& row = run_->row(person);
  for (std::size_t column = 0; column < row.size(); ++column) {
    const Contact& found = row[column];
    if (!found.hit()) continue;
    RecordedContact& contact = contacts_.emplace_back();
    contact.frame = frame_.index;
    contact.time_s = frame_.time_s();
    contact.collider = ids_[column];
    contact.triangle = found.triangle;
    contact.barycentric = found.barycentric;
    contact.actuator = found.actuator;
    contact.avatar = static_cast<std::uint16_t>(person + 1);
  }
}

}  // namespace vestige::plot
