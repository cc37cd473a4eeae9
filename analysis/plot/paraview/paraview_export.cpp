#include "analysis/plot/paraview/paraview_export.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "analysis/run/detection_run.hpp"
#include "detector/actuators/actuator_layout.hpp"
#include "detector/depth/depth_detector.hpp"
#include "detector/detector.hpp"
#include "detector/detectors/make_detectors.hpp"

namespace vestige::plot {

namespace {

/// Says which frames become steps.
class StepClock {
 public:
  explicit StepClock(const ParaviewOptions& options) : every_(options.every), rate_hz_(options.rate_hz) {}

  bool is_due(double time_s) {
    const std::uint64_t frame = frames_++;
    if (every_) return frame % *every_ == 0;
    if (frame == 0) first_s_ = time_s;
    // Sums of times land a hair beside the round number.
    const double periods = (time_s - first_s_) * rate_hz_ + 1e-6;
    if (periods < next_period_) return false;
    next_period_ = std::floor(periods) + 1;
    return true;
  }

 private:
  std::optional<std::uint64_t> every_;
  double rate_hz_;
  std::uint64_t frames_ = 0;
  double first_s_ = 0;
  double next_period_ = 0;
};

/// What came together since the last step.
struct Pending {
  std::vector<float> amplitude;
  std::vector<PlacedContact> contacts;

  void clear() {
    std::ranges::fill(amplitude, 0.0F);
    contacts.clear();
  }
};

}  // namespace

ParaviewResult export_to_paraview(TraceReader& trace, const Subject& subject, const ParaviewOptions& options,
                                  ParaviewSeries& series, const std::function<bool(double)>& progress) {
  const std::vector<std::uint32_t> ids = trace.collider_ids();
  const auto frame_count = static_cast<double>(std::max<std::uint64_t>(1, trace.frame_count()));
  DetectorOptions detector_options;
  detector_options.planes = PlaneSet::all();
  detector_options.skip = Skip::kOn;
  const std::unique_ptr<Detector> detector =
      with_depth(make_cpu_detector(subject.avatar, subject.map, detector_options), subject.avatar);
  const std::size_t actuators = subject.map.actuator_count;
  std::unique_ptr<IntensityLaw> law;
  if (actuators > 0)
    law =
        make_law(options.law, std::make_shared<const ActuatorLayout>(subject.avatar, subject.map), options.law_options);
  const std::vector<DetectedPerson> people = {{options.person, subject.avatar, *detector}};
  DetectionRun detection(people, ids);
  StepClock clock(options);
  Pending pending;
  pending.amplitude.assign(actuators, 0);
  ParaviewResult result;
  // A step is written when time goes on, so that it has all frames of its time.
  TraceFrame last;
  Pose shown = rest_pose(subject.avatar);  // where a pose is missing, the one before stays
  double last_s = 0;
  bool is_due = false;
  const auto write_last = [&] {
    series.write({last_s, &shown, pending.amplitude, last.colliders, pending.contacts});
    pending.clear();
    is_due = false;
  };

  trace.rewind();
  TraceFrame frame;
  while (trace.next(frame)) {
    detection.step(frame);
    const DetectorFrame& built = detection.frame();
    const ContactRow& row = detection.row();
    if (is_due && built.time_s > last_s) write_last();
    for (std::size_t column = 0; column < row.size(); ++column) {
      const Contact& contact = row[column];
      if (!contact.hit()) continue;
      ++result.contacts;
      pending.contacts.push_back({built.time_s, contact.position + built.origin_m, ids[column], contact.triangle,
                                  contact.actuator, contact.side, contact.speed_m_per_s, contact.depth_m});
    }
    if (law != nullptr) {
      const std::vector<double>& amplitude = law->next(built.time_s, row, &built);
      for (std::size_t i = 0; i < actuators; ++i)
        pending.amplitude[i] = std::max(pending.amplitude[i], static_cast<float>(amplitude[i]));
    }
    ++result.frames;
    is_due |= clock.is_due(built.time_s);
    last_s = built.time_s;
    std::swap(frame, last);
    if (!last.poses[options.person].nodes.empty()) shown = last.poses[options.person];
    if (!progress(static_cast<double>(result.frames) / frame_count)) {
      result.interrupted = true;
      break;
    }
  }
  if (result.frames > 0) write_last();
  return result;
}

}  // namespace vestige::plot
