#include "analysis/frequency/stage_pass.hpp"

#include <chrono>

#include "analysis/base/clocks.hpp"
#include "analysis/run/detection_run.hpp"

namespace vestige {

namespace {

constexpr int kLeastPasses = 3;

/// Returns the number of frames.
std::uint64_t run_pass(const Avatar& avatar, std::span<const StagePlace> places, Detector& detector) {
  std::uint64_t frames = 0;
  for (const StagePlace& place : places) {
    DetectionRun detection(avatar, place.collider_ids, detector);
    detection.begin(place.frames.front());
    for (const TraceFrame& frame : place.frames.subspan(1)) detection.step(frame);
    frames += place.frames.size() - 1;
  }
  return frames;
}

/// Lets a detector time its stages as long as this object lives.
class TimedStages {
 public:
  TimedStages(Detector& detector, StageClock& clock) : detector_(detector) { detector.time_stages(&clock); }
  ~TimedStages() { detector_.time_stages(nullptr); }
  TimedStages(const TimedStages&) = delete;
  TimedStages& operator=(const TimedStages&) = delete;

 private:
  Detector& detector_;
};

}  // namespace

double StageMeans::total_us() const {
  double total = 0;
  for (const StageTime& stage : stages) total += stage.us;
  return total;
}

StageMeans measure_stages(const Avatar& avatar, std::span<const StagePlace> places, Detector& detector,
                          double least_s) {
  StageClock clock;
  const TimedStages timed(detector, clock);
  run_pass(avatar, places, detector);
  clock.reset();
  std::uint64_t frames = 0;
  const auto start = std::chrono::steady_clock::now();
  for (int pass = 0; pass < kLeastPasses || seconds(std::chrono::steady_clock::now() - start) < least_s; ++pass)
    frames += run_pass(avatar, places, detector);
  StageMeans means = {clock.times(), clock.drawn_by()};
  for (StageTime& stage : means.stages) stage.us /= static_cast<double>(frames);
  return means;
}

}  // namespace vestige
