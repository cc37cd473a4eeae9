#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/run/detection_run.hpp"
#include "detector/stages.hpp"
#include "traces/scene/trace.hpp"

namespace vestige {

/// The mean times of a frame's stages.
struct StageMeans {
  std::vector<StageTime> stages;  ///< only those that the detector went through, in the order of `Stage`
  DrawnBy drawn_by = DrawnBy::kNothing;

  bool empty() const { return stages.empty(); }
  double total_us() const;
};

/// Consecutive frames of a trace, at least two, and the colliders that are tested in them (as in `FrameBuilder`).
struct StagePlace {
  std::span<const TraceFrame> frames;
  std::span<const std::uint32_t> collider_ids;
};

/// Measures how long each stage of a frame takes, as means over all frames but the first of each place. Reading clocks
/// slows the detector down, so nothing else may be concluded from these frames. All places are run once to warm up.
/// Then they are run again and again, at least three times and for at least `least_s`. The stages of all `people` are
/// added up. Afterwards, their detectors time no stages.
StageMeans measure_stages(std::span<const DetectedPerson> people, std::span<const StagePlace> places, double least_s);

}  // namespace vestige
