#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "analysis/run/detection_run.hpp"
#include "detector/contact.hpp"
#include "detector/detector.hpp"
#include "traces/scene/trace.hpp"
#include "traces/timeline/timeline.hpp"

namespace vestige {

/// What turns contacts into what vests are told. `person` is a place in the list of people.
struct FeltCalls {
  using Clock = std::chrono::steady_clock;

  /// Turns the contacts of a frame into what the vest is told. `frame` is null in a gap. The reference is valid until
  /// the next call.
  using Law = std::function<const ActuatorFrame&(double time_s, const ContactRow& row, const DetectorFrame* frame)>;

  /// Makes each person's law.
  std::function<std::vector<Law>()> make_laws = {};
  /// Called for each person after each frame, and during gaps, with what to tell the vest and when that was due.
  std::function<void(std::size_t person, const ActuatorFrame&, Clock::time_point due)> take = {};
};

/// What was found on one person.
struct FeltPerson {
  std::uint64_t contacts = 0;
  std::uint64_t non_finite_frames = 0;  ///< counted by `FrameBuilder`
  std::uint64_t non_finite_segments = 0;
};

/// Takes frames through detectors and laws, to those who feel them. Precondition of all but the constructor and
/// `finish`: `begin_run` was called.
class FeltFrames {
 public:
  using Clock = FeltCalls::Clock;

  /// Keeps references to all. `ids` as in `ColliderMoves`.
  FeltFrames(std::span<const DetectedPerson> people, std::span<const std::uint32_t> ids, const FeltCalls& calls);

  /// Forgets everything: the next frame is a first one.
  void begin_run();
  /// Makes the laws anew, so that no contact before is felt any more. Frames go on.
  void forget_contacts();
  /// As `DetectionRun::use_ids`. Keeps a reference to `ids`.
  void use_ids(std::span<const std::uint32_t> ids, const TraceFrame& before);

  /// Whether a person feels nothing for now, whatever touches them. Their law is made anew.
  void mute(std::size_t person, bool is_muted);

  /// The laws go on, without contacts.
  void gap(double time_s, Clock::time_point now);
  /// Detects in a frame, and tells what is felt.
  void take(const TraceFrame& frame, double time_s, Clock::time_point due);
  /// When the contacts of the frame taken last had been found.
  Clock::time_point detected() const { return detected_; }
  /// The contacts of the frame taken last.
  const ContactRow& row(std::size_t person) const { return detection_->row(person); }

  std::vector<FeltPerson> finish();

 private:
  /// Adds up what the run that has ended counted.
  void count_faults();

  std::span<const DetectedPerson> people_;
  std::span<const std::uint32_t> ids_;
  const FeltCalls& calls_;
  ContactRow nothing_;
  std::vector<FeltPerson> found_;
  std::optional<DetectionRun> detection_;
  std::vector<FeltCalls::Law> laws_;
  std::vector<bool> is_muted_;
  Clock::time_point detected_;
};

}  // namespace vestige
