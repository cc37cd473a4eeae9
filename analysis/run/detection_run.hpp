#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "detector/collider_moves.hpp"
#include "detector/contact.hpp"
#include "detector/detector.hpp"
#include "detector/frame.hpp"
#include "detector/stages.hpp"
#include "traces/scene/avatar.hpp"
#include "traces/scene/trace.hpp"

namespace vestige {

/// A person of a trace, and the detector that finds what touches that person.
struct DetectedPerson {
  std::size_t person = 0;  ///< counted from 0
  const Avatar& avatar;
  Detector& detector;
};

/// Takes people through consecutive frames of a trace: builds each frame, then detects the contacts in it. Each person
/// has a detector of their own.
class DetectionRun {
 public:
  /// `collider_ids` as in `ColliderMoves`. Keeps references to the avatars and detectors.
  DetectionRun(std::span<const DetectedPerson> people, std::span<const std::uint32_t> collider_ids)
      : colliders_(collider_ids) {
    for (const DetectedPerson& one : people)
      people_.push_back(
          {one.detector, FrameBuilder(one.avatar, {}, one.detector.method(), one.person, one.detector.skip())});
  }
  /// For the first person alone.
  DetectionRun(const Avatar& avatar, std::span<const std::uint32_t> collider_ids, Detector& detector)
      : DetectionRun(std::vector<DetectedPerson>{{0, avatar, detector}}, collider_ids) {}

  /// From now on, the colliders are those of `collider_ids`, which holds all ids before: for input whose ids are not
  /// known beforehand. `before` is the frame given before; what moves from it to the next frame is found as ever.
  void use_ids(std::span<const std::uint32_t> collider_ids, const TraceFrame& before) {
    colliders_ = ColliderMoves(collider_ids);
    colliders_.next(before);
  }

  /// Only says where everything comes from: nothing is detected in this frame. Makes room for the rows.
  void begin(const TraceFrame& first) {
    colliders_.next(first);
    for (Person& one : people_) {
      one.builder.next(first, colliders_);
      one.row.clear(colliders_.columns());
    }
  }

  /// Detects in the frame after the one given before. Its results stay good until the next call.
  /// If a detector times its stages, the frame's making belongs to Stage::kPose, as does all that the detector does
  /// before its own first stage. Following the colliders counts there for the first person.
  DetectorWork step(const TraceFrame& trace_frame) {
    DetectorWork work;
    for (std::size_t i = 0; i < people_.size(); ++i) {
      Person& one = people_[i];
      StageClock* const clock = one.detector.stage_clock();
      enter_stage(clock, Stage::kPose);
      if (i == 0) colliders_.next(trace_frame);
      one.frame = &one.builder.next(trace_frame, colliders_);
      work += one.detector.detect(*one.frame, one.row);
      if (clock != nullptr) clock->leave();
    }
    return work;
  }

  /// Precondition of both: `step` was called. `i` is the place in the list of people.
  const DetectorFrame& frame(std::size_t i = 0) const { return *people_[i].frame; }
  const ContactRow& row(std::size_t i = 0) const { return people_[i].row; }

  /// Says how many frames and segments were not finite, and how often the origin changed.
  const FrameBuilder& builder(std::size_t i = 0) const { return people_[i].builder; }

 private:
  struct Person {
    Detector& detector;
    FrameBuilder builder;
    const DetectorFrame* frame = nullptr;
    ContactRow row = {};
  };
  ColliderMoves colliders_;
  std::vector<Person> people_;
};

}  // namespace vestige
