#include "analysis/run/seen_run.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "traces/base/number_text.hpp"

namespace vestige {

std::string describe_non_finite(std::uint64_t frames, std::uint64_t segments, std::optional<std::uint64_t> first) {
  if (!first) return "";
  return fmt::format("{} and the ends of {} are not finite, the first in frame {}; they fired nothing",
                     counted(frames, "pose"), counted(segments, "segment"), *first);
}

SeenRun::SeenRun(const Input& input, const MakeDetectors& make)
    : people_(input.people.begin(), input.people.end()),
      collider_ids_(input.collider_ids.begin(), input.collider_ids.end()),
      makers_(people_.size()),
      drives_(people_.size()) {
  PlaneSet planes = input.planes;
  for (std::size_t i = 0; i < people_.size(); ++i) {
    const MappedPerson& person = people_[i];
    if (person.map.actuator_count == 0) continue;
    planes = planes | makers_[i].emplace(input.law, person.avatar, person.map).planes();
  }
  detectors_ = make(planes);
  rewind();
}

void SeenRun::rewind() {
  std::vector<DetectedPerson> detected;
  for (std::size_t i = 0; i < people_.size(); ++i) {
    detected.push_back({i, people_[i].avatar, *detectors_[i]});
    if (makers_[i]) drives_[i] = makers_[i]->make();
  }
  run_.emplace(detected, collider_ids_);
  seen_.clear();
}

void SeenRun::step(const TraceFrame& frame) {
  run_->step(frame);
  seen_.clear();
  for (std::size_t i = 0; i < people_.size(); ++i) {
    const ActuatorFrame* felt =
        drives_[i] == nullptr ? nullptr : &drives_[i]->next(frame.time_s(), run_->row(i), &run_->frame(i));
    seen_.push_back({run_->frame(i), run_->row(i), felt});
  }
}

bool SeenRun::any_feels() const {
  return std::ranges::any_of(makers_, [](const auto& maker) { return maker.has_value(); });
}

nlohmann::ordered_json SeenRun::law() const {
  const auto maker = std::ranges::find_if(makers_, [](const auto& one) { return one.has_value(); });
  return maker == makers_.end() ? nlohmann::ordered_json() : (*maker)->to_json();
}

std::string SeenRun::non_finite(std::size_t person) const {
  const FrameBuilder& built = run_->builder(person);
  return describe_non_finite(built.non_finite_frames(), built.non_finite_segments(), built.first_non_finite());
}

}  // namespace vestige
