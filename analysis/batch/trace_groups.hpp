#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

namespace vestige {

/// Which traces of a batch belong together: a scenario's, with other seeds, or all recorded files. Named scenarios are
/// fixed; what could have been otherwise are their seeds, and the files.
struct TraceGroups {
  std::vector<std::string> names;     ///< of the scenarios, or "files"
  std::vector<std::size_t> of_trace;  ///< index into `names`
  /// Strata for `rank_candidates`: `of_trace`, or each trace for itself if there are too few for intervals.
  std::vector<std::size_t> strata;
  std::string over;  ///< what a mean is over: "6 scenarios x 20 seeds", "9 files", "2 scenarios and 3 files"
  std::string why_no_intervals;  ///< a clause without a comma; empty if there are enough traces
};

/// Groups the traces of these names, in their order. `batch` is `to_json(plan)`.
TraceGroups group_traces(const nlohmann::ordered_json& batch, std::span<const std::string> names);

}  // namespace vestige
