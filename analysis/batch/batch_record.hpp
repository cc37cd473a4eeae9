#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "analysis/batch/batch_folder.hpp"
#include "analysis/batch/batch_plan.hpp"

namespace vestige {

/// One finished trace, for run.json: its input, what it holds and what it took. `earlier`: an earlier run finished it.
nlohmann::ordered_json trace_record(const BatchTrace& trace, const nlohmann::ordered_json& item,
                                    const BatchFolder& folder, bool earlier);

/// The warnings about avatar and maps, for run.json: {"avatar": {"warnings": […]}, "maps": [{"name", "warnings"}, …]}.
nlohmann::ordered_json input_warnings(const BatchPlan& plan);

/// Sums of what finished traces took, and how many scores there are.
nlohmann::ordered_json totals(const nlohmann::ordered_json& traces, std::size_t scores_per_trace);

nlohmann::ordered_json to_json(const BatchFailure& failure);

/// Whether an item was made of less than its whole trace: damaged chunks, poses or colliders that are not finite. Says
/// so, one sentence each.
std::vector<std::string> losses_of(const nlohmann::ordered_json& item);

}  // namespace vestige
