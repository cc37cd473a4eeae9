#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "analysis/scoring/scores.hpp"
#include "detector/detector.hpp"
#include "detector/detectors/make_detectors.hpp"
#include "tests/support/flat_body.hpp"
#include "tests/support/scene_run.hpp"

namespace vestige::test {

/// Returns the metric `name` of a result. Throws if there is no such metric.
inline double metric(const Scores& scores, std::string_view name) {
  const auto found = std::ranges::find(metrics(), name, &Metric::name);
  return scores.at(static_cast<std::size_t>(found - metrics().begin()));
}

/// Returns the contacts of a built-in scenario around an avatar.
inline ContactRecording record_scenario(std::string_view scenario, const Avatar& avatar, std::uint32_t colliders,
                                        int frames, double rate_hz) {
  const ActuatorMap none;
  const auto detector = make_cpu_detector(avatar, none, {.planes = kRecordedPlanes, .skip = Skip::kOn});
  FrameBuilder builder = frame_builder(avatar, colliders, Method::kStatic);
  ContactRecording recording;
  ContactRow row;
  for (const TraceFrame& trace_frame : scene(scenario, avatar, colliders, frames, rate_hz)) {
    const DetectorFrame& frame = builder.next(trace_frame);
    detector->detect(frame, row);
    recording.add(frame.time_s, row);
  }
  return recording;
}

}  // namespace vestige::test
