#pragma once

#include <string>
#include <vector>

#include "analysis/plot/data/report_data.hpp"

namespace vestige::plot {

// What the report says in words. All functions return HTML.

/// Returns one sentence that a paper can quote: which map and law came first, of which, by what, over which traces,
/// with what interval, and what share of the contacts was felt. It names a detector that is approximate. It says only
/// what the batch's folder holds.
std::string quotable_sentence(const ReportData& data);

/// Returns how the others compare with the first: which have its value, which are worse, which have none.
/// Precondition: the first has a value.
std::string others_in_words(const ReportData& data);

/// Returns what a reader must know before believing the result, one sentence or two each.
std::vector<std::string> cautions(const ReportData& data);

/// Returns what would change the result, one paragraph each: more seeds or files, other scenarios, another metric,
/// motors.
std::vector<std::string> what_would_change(const ReportData& data);

}  // namespace vestige::plot
