#include "analysis/replay.hpp"

#include <algorithm>
#include <chrono>
#include <span>

#include "detector/intensity.hpp"
#include "detector/texture_hash.hpp"

namespace vestige {

namespace {

constexpr std::uint64_t kSkinningFrames = 5;

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Turns the contacts of a CSV file back into rows, frame by frame.
class RecordedRows {
 public:
  RecordedRows(std::span<const RecordedContact> contacts, std::span<const std::uint32_t> collider_ids)
      : contacts_(contacts), collider_ids_(collider_ids) {}

  const ContactRow& row_of(std::uint64_t frame) {
    row_.assign(collider_ids_.size(), Contact());
    while (next_ < contacts_.size() && contacts_[next_].frame < frame) skip();
    for (; next_ < contacts_.size() && contacts_[next_].frame == frame; ++next_) {
      const RecordedContact& recorded = contacts_[next_];
      const auto place = std::ranges::lower_bound(collider_ids_, recorded.collider);
      if (place == collider_ids_.end() || *place != recorded.collider) {
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

  /// Contacts of frames or colliders that the trace does not have, those never asked for included.
  std::uint64_t strangers() const { return strangers_ + (contacts_.size() - next_); }

 private:
  void skip() {
    ++strangers_;
    ++next_;
  }

  std::span<const RecordedContact> contacts_;
  std::span<const std::uint32_t> collider_ids_;
  std::size_t next_ = 0;
  std::uint64_t strangers_ = 0;
  ContactRow row_;
};

}  // namespace

ReplayResult replay(TraceReader& trace, const Avatar& avatar, std::size_t actuator_count, Detector& detector,
                    double hold_s, const ReplayOutputs& outputs, const ReplayExpectation& expectation,
                    const std::function<bool(double)>& progress) {
  const std::vector<std::uint32_t>& ids = trace.collider_ids();
  const std::uint64_t frame_count = trace.frame_count();
  const std::uint64_t skinning_step = std::max<std::uint64_t>(1, frame_count / kSkinningFrames);

  ReplayResult result;
  result.contacts_of_actuator.resize(actuator_count + 1);
  if (expectation.detector != nullptr || expectation.contacts != nullptr) result.comparison.emplace();
  RecordedRows recorded(
      expectation.contacts != nullptr ? std::span(*expectation.contacts) : std::span<const RecordedContact>(), ids);
  FrameBuilder builder(avatar, ids, detector.method());
  BinaryLaw law(actuator_count, hold_s);
  TextureHash hash;
  TraceFrame trace_frame;
  ContactRow row;
  ContactRow expected;
  trace.rewind();
  const auto next_frame = [&] {
    const auto start = std::chrono::steady_clock::now();
    const bool more = trace.next(trace_frame);
    result.reading_s += seconds_since(start);
    return more;
  };
  while (next_frame()) {
    const auto start = std::chrono::steady_clock::now();
    const Frame& frame = builder.next(trace_frame);
    const DetectorWork work = detector.detect(frame, row);
    result.detection_s += seconds_since(start);

    result.frames_skipped += work.frames_skipped;
    result.pairs_tested += work.pairs_tested;
    result.pairs_captured += work.pairs_captured;
    result.pairs_meeting += work.pairs_meeting;
    result.unsure += work.unsure;
    for (const Contact& contact : row) {
      if (!contact.hit()) continue;
      ++result.contacts;
      ++result.contacts_of_actuator[contact.actuator];
    }
    hash.add(row);
    if (outputs.contacts != nullptr) outputs.contacts->write(frame, row, ids);
    if (outputs.textures != nullptr) outputs.textures->add(frame, row);
    if (outputs.timeline != nullptr) outputs.timeline->write(law.next(frame.time_s, row));
    if (expectation.detector != nullptr) {
      expectation.detector->detect(frame, expected);
      result.comparison->add(row, expected);
    } else if (expectation.contacts != nullptr) {
      result.comparison->add(row, recorded.row_of(frame.index));
    }
    if (result.frames % skinning_step == 0) result.skinning.add(avatar, trace_frame, frame, detector);
    ++result.frames;
    if (!progress(static_cast<double>(result.frames) / static_cast<double>(frame_count))) {
      result.interrupted = true;
      break;
    }
  }
  if (expectation.contacts != nullptr && !result.interrupted) {
    result.comparison->missing += recorded.strangers();
    result.comparison->expected += recorded.strangers();
  }
  result.texture_hash = hash.hex();
  result.origin_changes = builder.origin_changes();
  result.non_finite_frames = builder.non_finite_frames();
  result.non_finite_segments = builder.non_finite_segments();
  result.first_non_finite = builder.first_non_finite();
  return result;
}

}  // namespace vestige
