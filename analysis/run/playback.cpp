#include "analysis/run/playback.hpp"

#include <optional>
#include <utility>
#include <vector>

namespace vestige {

namespace {

/// Takes the frames of a playback through detectors and laws.
class DetectedPlayback {
 public:
  DetectedPlayback(std::span<const DetectedPerson> people, std::span<const std::uint32_t> ids,
                   const PlaybackCalls& calls)
      : people_(people), ids_(ids), calls_(calls), nothing_(ids.size()), found_(people.size()) {}

  void begin_run() {
    count_faults();
    detection_.emplace(people_, ids_);
    laws_ = calls_.make_laws();
  }

  void gap(double time_s, PlaybackCalls::Clock::time_point now) {
    for (std::size_t i = 0; i < laws_.size(); ++i) calls_.take(i, laws_[i](time_s, nothing_, nullptr), now);
  }

  void take(const TraceFrame& frame, double time_s, PlaybackCalls::Clock::time_point due) {
    detection_->step(frame);
    for (std::size_t i = 0; i < laws_.size(); ++i)
      calls_.take(i, laws_[i](time_s, detection_->row(i), &detection_->frame(i)), due);
    for (std::size_t i = 0; i < found_.size(); ++i) found_[i].contacts += detection_->row(i).hits();
  }

  std::vector<PlaybackResult::Person> finish() {
    count_faults();
    return std::move(found_);
  }

 private:
  /// Adds up what the run that has ended counted.
  void count_faults() {
    if (!detection_) return;
    for (std::size_t i = 0; i < found_.size(); ++i) {
      found_[i].non_finite_frames += detection_->builder(i).non_finite_frames();
      found_[i].non_finite_segments += detection_->builder(i).non_finite_segments();
    }
  }

  std::span<const DetectedPerson> people_;
  std::span<const std::uint32_t> ids_;
  const PlaybackCalls& calls_;
  ContactRow nothing_;
  std::vector<PlaybackResult::Person> found_;
  std::optional<DetectionRun> detection_;
  std::vector<PlaybackCalls::Law> laws_;
};

}  // namespace

PlaybackResult play(TraceReader& trace, std::span<const DetectedPerson> people, const PlaybackOptions& options,
                    const PlaybackCalls& calls) {
  DetectedPlayback playback(people, trace.collider_ids(), calls);
  const FrameCalls paced = {
      .begin_run = [&] { playback.begin_run(); },
      .go_on = calls.go_on,
      .gap = [&](double time_s, PlaybackCalls::Clock::time_point now) { playback.gap(time_s, now); },
      .fell_behind = calls.fell_behind,
      .take = [&](const TraceFrame& frame, double time_s,
                  PlaybackCalls::Clock::time_point due) { playback.take(frame, time_s, due); },
  };
  PlaybackResult result = {play_frames(trace, options, paced)};
  result.people = playback.finish();
  return result;
}

}  // namespace vestige
