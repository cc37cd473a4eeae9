#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "analysis/batch/batch_folder.hpp"
#include "analysis/batch/batch_plan.hpp"

namespace vestige {

/// Returns the record of a finished trace for run.json: its input, its contents and its durations. `earlier` says that
/// an earlier run finished the trace.
nlohmann::ordered_json trace_record(const BatchTrace& trace, const nlohmann::ordered_json& item,
                                    const BatchFolder& folder, bool earlier);

/// Returns the warnings about avatar and maps for run.json: {"avatar": {"warnings": […]}, "maps": [{"name",
/// "warnings"}, …]}.
nlohmann::ordered_json input_warnings(const BatchPlan& plan);

/// Returns the sums of the durations of finished traces, and the number of scores.
nlohmann::ordered_json totals(const nlohmann::ordered_json& traces, std::size_t scores_per_trace);

nlohmann::ordered_json to_json(const BatchFailure& failure);

/// Returns why an item was made of less than its whole trace, one sentence each: damaged chunks, poses or colliders
/// that are not finite. Empty if nothing was lost.
std::vector<std::string> losses_of(const nlohmann::ordered_json& item);

}  // namespace vestige
