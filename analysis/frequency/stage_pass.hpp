#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "detector/detector.hpp"
#include "detector/stages.hpp"
#include "traces/scene/avatar.hpp"
#include "traces/scene/trace.hpp"

namespace vestige {

/// The mean times of a frame's stages.
struct StageMeans {
  std::vector<StageTime> stages;  ///< only those that the detector went through, in the order of `Stage`
  DrawnBy drawn_by = DrawnBy::kNothing;

  bool empty() const { return stages.empty(); }
  double total_us() const;
};

/// Measures how long each stage of a frame takes, as means over all frames but the first of each place. Reading clocks
/// slows the detector down, so this is no pass whose frames are timed for anything else. All places are run once to
/// warm up. Then they are run again and again, at least three times and for at least `least_s`. A place is a list of
/// consecutive frames; `collider_ids` as in `FrameBuilder`. Afterwards, the detector times no stages.
StageMeans measure_stages(const Avatar& avatar, std::span<const std::uint32_t> collider_ids,
                          std::span<const std::vector<TraceFrame>> places, Detector& detector, double least_s);

}  // namespace vestige
