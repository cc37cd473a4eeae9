#include "analysis/frequency/stage_pass.hpp"

#include <chrono>

#include "analysis/base/clocks.hpp"

namespace vestige {

namespace {

constexpr int kLeastPasses = 3;

/// Returns the number of frames.
std::uint64_t run_pass(std::span<const DetectedPerson> people, std::span<const StagePlace> places) {
  std::uint64_t frames = 0;
  for (const StagePlace& place : places) {
    DetectionRun detection(people, place.collider_ids);
    detection.begin(place.frames.front());
    for (const TraceFrame& frame : place.frames.subspan(1)) detection.step(frame);
    frames += place.frames.size() - 1;
  }
  return frames;
}

/// Lets detectors time their stages as long as this object lives.
class TimedStages {
 public:
  TimedStages(std::span<const DetectedPerson> people, StageClock& clock) : people_(people) {
    for (const DetectedPerson& one : people) one.detector.time_stages(&clock);
  }
  ~TimedStages() {
    for (const DetectedPerson& one : people_) one.detector.time_stages(nullptr);
  }
  TimedStages(const TimedStages&) = delete;
  TimedStages& operator=(const TimedStages&) = delete;

 private:
  std::span<const DetectedPerson> people_;
};

}  // namespace

double StageMeans::total_us() const {
  double total = 0;
  for (const StageTime& stage : stages) total += stage.us;
  return total;
}

StageMeans measure_stages(std::span<const DetectedPerson> people, std::span<const StagePlace> places, double least_s) {
  StageClock clock;
  const TimedStages timed(people, clock);
  run_pass(people, places);
  clock.reset();
  std::uint64_t frames = 0;
  const auto start = std::chrono::steady_clock::now();
  for (int pass = 0; pass < kLeastPasses || seconds(std::chrono::steady_clock::now() - start) < least_s; ++pass)
    frames += run_pass(people, places);
  StageMeans means = {clock.times(), clock.drawn_by()};
  for (StageTime& stage : means.stages) stage.us /= static_cast<double>(frames);
  return means;
}

}  // namespace vestige
