#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "analysis/accuracy.hpp"
#include "analysis/true_contacts.hpp"

namespace vestige {

/// The truth, and how much it changes when its rate is halved: `half` scored against `truth` as if it were a detector.
nlohmann::ordered_json to_json(const TrueContacts& truth, const TrueContacts& half, const std::string& detector);

/// Results only, the same bytes for the same work: a list of {detector, method, points[{rate_hz, frames, contacts,
/// true_events, found, mistaken, missed, …}]}.
nlohmann::ordered_json errors_json(std::span<const AccuracyPoint> points,
                                   const std::vector<AccuracyContestant>& contestants);

/// A list alike of what another run measures anew: {detector, method, gl, points[{rate_hz, hz, us_median, …}]}.
nlohmann::ordered_json times_json(std::span<const AccuracyPoint> points,
                                  const std::vector<AccuracyContestant>& contestants);

/// A line for each contestant and rate.
std::string accuracy_table(std::span<const AccuracyPoint> points, const std::vector<AccuracyContestant>& contestants,
                           const TrueContacts& truth, const TrueContacts& half);

}  // namespace vestige
