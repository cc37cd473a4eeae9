#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "analysis/compare/compare.hpp"

namespace vestige {

/// Returns "points", "only_a", "only_b", "changes" and "counts" (points by verdict). A point has name, verdict, ratio,
/// low, high (null if `speed_ratio` has no interval), hz_a, hz_b, passes_a, passes_b and same_answers. The frequencies
/// are those that the ratio is of: without what other programs added.
nlohmann::ordered_json to_json(const SweepComparison& comparison);

/// Returns a table for people, the slowest first, and a line that counts the verdicts.
std::string comparison_table(const SweepComparison& comparison, double threshold);

/// Returns a sentence, with its remedy, for each reason why a comparison says less than it seems to: contacts that
/// changed, points with too few passes, points that scatter too much.
std::vector<std::string> comparison_warnings(const SweepComparison& comparison);

}  // namespace vestige
