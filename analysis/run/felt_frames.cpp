#include "analysis/run/felt_frames.hpp"

#include <utility>

namespace vestige {

FeltFrames::FeltFrames(std::span<const DetectedPerson> people, std::span<const std::uint32_t> ids,
                       const FeltCalls& calls)
    : people_(people),
      ids_(ids),
      calls_(calls),
      nothing_(ids.size()),
      found_(people.size()),
      is_muted_(people.size()) {}

void FeltFrames::begin_run() {
  count_faults();
  detection_.emplace(people_, ids_);
  forget_contacts();
}

void FeltFrames::forget_contacts() {
  laws_ = calls_.make_laws();
}

void FeltFrames::use_ids(std::span<const std::uint32_t> ids, const TraceFrame& before) {
  ids_ = ids;
  nothing_ = ContactRow(ids.size());
  detection_->use_ids(ids, before);
}

void FeltFrames::mute(std::size_t person, bool is_muted) {
  if (is_muted_[person] == is_muted) return;
  is_muted_[person] = is_muted;
  laws_[person] = std::move(calls_.make_laws()[person]);
}

void FeltFrames::gap(double time_s, Clock::time_point now) {
  for (std::size_t i = 0; i < laws_.size(); ++i) calls_.take(i, laws_[i](time_s, nothing_, nullptr), now);
}

void FeltFrames::take(const TraceFrame& frame, double time_s, Clock::time_point due) {
  detection_->step(frame);
  detected_ = Clock::now();
  for (std::size_t i = 0; i < laws_.size(); ++i) {
    const ActuatorFrame& felt = is_muted_[i] ? laws_[i](time_s, nothing_, nullptr)
                                             : laws_[i](time_s, detection_->row(i), &detection_->frame(i));
    calls_.take(i, felt, due);
  }
  for (std::size_t i = 0; i < found_.size(); ++i) found_[i].contacts += detection_->row(i).hits();
}

std::vector<FeltPerson> FeltFrames::finish() {
  count_faults();
  detection_.reset();
  return std::move(found_);
}

void FeltFrames::count_faults() {
  if (!detection_) return;
  for (std::size_t i = 0; i < found_.size(); ++i) {
    found_[i].non_finite_frames += detection_->builder(i).non_finite_frames();
    found_[i].non_finite_segments += detection_->builder(i).non_finite_segments();
  }
}

}  // namespace vestige
