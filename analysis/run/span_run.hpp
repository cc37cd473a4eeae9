#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "analysis/run/detection_run.hpp"
#include "detector/collider_moves.hpp"
#include "detector/contact.hpp"
#include "detector/detector.hpp"
#include "detector/frame.hpp"
#include "traces/scene/trace.hpp"

namespace vestige {

/// Takes people through consecutive frames of a trace as `DetectionRun` does, but by spans of frames, which detectors
/// with a GPU keep in flight together (`Detector::detect_all`).
class SpanRun {
 public:
  /// `collider_ids` as in `ColliderMoves`. Keeps references to the avatars and detectors.
  SpanRun(std::span<const DetectedPerson> people, std::span<const std::uint32_t> collider_ids)
      : colliders_(collider_ids) {
    for (const DetectedPerson& one : people)
      people_.push_back(
          {one.detector, FrameBuilder(one.avatar, {}, one.detector.method(), one.person, one.detector.skip())});
  }

  /// Only says where everything comes from: nothing is detected in this frame.
  void begin(const TraceFrame& first) {
    colliders_.next(first);
    for (Person& one : people_) one.builder.next(first, colliders_);
  }

  /// Detects in the frames after those given before. The rows stay good until the next call.
  void step(std::span<const TraceFrame> trace_frames) {
    for (Person& one : people_) one.make_room(trace_frames.size());
    for (std::size_t k = 0; k < trace_frames.size(); ++k) {
      colliders_.next(trace_frames[k]);
      for (Person& one : people_) one.frames[k] = one.builder.next(trace_frames[k], colliders_);
    }
    for (Person& one : people_)
      one.detector.detect_all(std::span(one.frames).first(trace_frames.size()),
                              std::span(one.rows).first(trace_frames.size()),
                              std::span(one.work).first(trace_frames.size()));
  }

  /// The row of the k-th frame of the last span, for the i-th of the people.
  const ContactRow& row(std::size_t i, std::size_t k) const { return people_[i].rows[k]; }

 private:
  struct Person {
    void make_room(std::size_t count) {
      if (frames.size() >= count) return;
      frames.resize(count);
      rows.resize(count);
      work.resize(count);
    }

    Detector& detector;
    FrameBuilder builder;
    std::vector<DetectorFrame> frames = {};
    std::vector<ContactRow> rows = {};
    std::vector<DetectorWork> work = {};
  };
  ColliderMoves colliders_;
  std::vector<Person> people_;
};

}  // namespace vestige
