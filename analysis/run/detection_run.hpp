#pragma once

#include <cstdint>
#include <span>

#include "detector/contact.hpp"
#include "detector/detector.hpp"
#include "detector/frame.hpp"
#include "detector/stages.hpp"
#include "traces/scene/avatar.hpp"
#include "traces/scene/trace.hpp"

namespace vestige {

/// Takes one detector through consecutive frames of a trace: builds each frame, then detects the contacts in it.
class DetectionRun {
 public:
  /// `collider_ids` as in `FrameBuilder`. Keeps references to `avatar` and `detector`.
  DetectionRun(const Avatar& avatar, std::span<const std::uint32_t> collider_ids, Detector& detector)
      : detector_(detector), builder_(avatar, collider_ids, detector.method(), 0, detector.skip()) {}

  /// Only says where everything comes from: nothing is detected in this frame.
  void begin(const TraceFrame& first) { builder_.next(first); }

  /// Detects in the frame after the one given before. Its results stay good until the next call.
  /// If the detector times its stages, the frame's making belongs to Stage::kPose, as does all that a detector does
  /// before its own first stage.
  DetectorWork step(const TraceFrame& trace_frame) {
    StageClock* const clock = detector_.stage_clock();
    enter_stage(clock, Stage::kPose);
    frame_ = &builder_.next(trace_frame);
    const DetectorWork work = detector_.detect(*frame_, row_);
    if (clock != nullptr) clock->leave();
    return work;
  }

  /// Precondition of both: `step` was called.
  const DetectorFrame& frame() const { return *frame_; }
  const ContactRow& row() const { return row_; }

  /// Says how many frames and segments were not finite, and how often the origin changed.
  const FrameBuilder& builder() const { return builder_; }

 private:
  Detector& detector_;
  FrameBuilder builder_;
  const DetectorFrame* frame_ = nullptr;
  ContactRow row_;
};

}  // namespace vestige
