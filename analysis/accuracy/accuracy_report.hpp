#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "analysis/accuracy/accuracy.hpp"

namespace vestige {

/// Returns only results, without timings: the same work gives the same bytes. The result is a list of {colliders,
/// count, seeds, truth{…, halved{…}}, series[{detector, approximate, method, points[{rate_hz, frames, contacts,
/// true_events, found, mistaken, missed, …, wrong_share{value, low, high}, …, within_tolerance{…}}]}]}. `halved`
/// tells how much the truth changes at half its rate: the half-rate events are scored as if a detector had found them.
/// The intervals are 95 %, by the bootstrap over colliders of all seeds.
nlohmann::ordered_json errors_json(std::span<const AccuracyScene> scenes,
                                   const std::vector<AccuracyContestant>& contestants, const std::string& truth);

/// Returns the values that every run measures anew, as a similar list: {colliders, pareto[{detector, method, rate_hz,
/// …}], series[{detector, method, gl,
/// points[{rate_hz, hz, us_median, …, processor_ms_per_s, …}]}]}.
nlohmann::ordered_json times_json(std::span<const AccuracyScene> scenes,
                                  const std::vector<AccuracyContestant>& contestants);

/// Returns a table for each scene, with a line for each contestant and rate.
std::string accuracy_table(std::span<const AccuracyScene> scenes, const std::vector<AccuracyContestant>& contestants,
                           double tolerance_s);

}  // namespace vestige
