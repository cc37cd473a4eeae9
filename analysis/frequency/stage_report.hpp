#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "analysis/frequency/stage_pass.hpp"
#include "analysis/frequency/sweep.hpp"

namespace vestige {

/// Returns `stages{name: microseconds}` and, for a detector that draws, `draw_by` ("timer" or "clock"): members of a
/// point in a sweep's JSON. Empty if no stage was measured.
nlohmann::ordered_json to_json(const StageMeans& means);

/// Returns a table for people: the microseconds of each series in each stage, at every number of colliders of a sweep
/// with up to three, otherwise at the largest. Empty if no stage was measured.
std::string stage_table(std::span<const SweepSeries> series);

}  // namespace vestige
