#include "cli/show/watchers.hpp"

#include <algorithm>

namespace vestige::cli {

Watchers::Watchers(std::span<const TracedPerson> people, OpenTrace& trace, const std::string& file,
                   const WatchChoice& choice)
    : trace_(trace) {
  PlaneSet planes = choice.planes;
  for (const TracedPerson& person : people) {
    drives_.emplace_back();
    if (person.map.actuator_count == 0) continue;
    require_spheres(std::span(&choice.law.law, 1), trace.reader.has_spheres(), file);
    const DriveMaker maker(choice.law, person.avatar, person.map);
    planes = planes | maker.planes();
    drives_.back() = maker.make();
  }
  detectors_ = make_detectors(choice.detector.detector, choice.detector, people, planes);
  std::vector<DetectedPerson> detected;
  for (std::size_t i = 0; i < people.size(); ++i) detected.push_back({i, people[i].avatar, *detectors_[i]});
  run_.emplace(detected, trace.reader.collider_ids());
}

void Watchers::step(const TraceFrame& frame) {
  run_->step(frame);
  seen_.clear();
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    const ActuatorFrame* felt =
        drives_[i] == nullptr ? nullptr : &drives_[i]->next(frame.time_s(), run_->row(i), &run_->frame(i));
    seen_.push_back({run_->frame(i), run_->row(i), felt});
  }
}

bool Watchers::any_feels() const {
  return std::ranges::any_of(drives_, [](const auto& drive) { return drive != nullptr; });
}

std::vector<std::string> Watchers::notes() const {
  std::vector<std::string> notes;
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    const FrameBuilder& built = run_->builder(i);
    const std::string note =
        describe_non_finite(built.non_finite_frames(), built.non_finite_segments(), built.first_non_finite());
    if (!note.empty()) notes.push_back(before_person(trace_, i) + note);
  }
  return notes;
}

}  // namespace vestige::cli
