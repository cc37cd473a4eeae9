#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "analysis/accuracy/accuracy.hpp"

namespace vestige {

/// Results only, the same bytes for the same work: a list of {colliders, count, truth{…, halved{…}}, series[{detector,
/// method, points[{rate_hz, frames, contacts, true_events, found, mistaken, missed, …}]}]}. `halved` says how much the
/// truth changes with half its rate: scored as if that were a detector.
nlohmann::ordered_json errors_json(std::span<const AccuracyScene> scenes,
                                   const std::vector<AccuracyContestant>& contestants, const std::string& truth);

/// A list alike of what another run measures anew: {colliders, series[{detector, method, gl, points[{rate_hz, hz,
/// us_median, …}]}]}.
nlohmann::ordered_json times_json(std::span<const AccuracyScene> scenes,
                                  const std::vector<AccuracyContestant>& contestants);

/// For each scene, a line for each contestant and rate.
std::string accuracy_table(std::span<const AccuracyScene> scenes, const std::vector<AccuracyContestant>& contestants);

}  // namespace vestige
