#pragma once

#include <functional>
#include <string>
#include <vector>

#include "analysis/batch/batch_plan.hpp"

namespace vestige {

/// Reads a batch's avatar and maps into `plan`, whose traces are named already. `avatar`: "builtin", a file, or empty:
/// the first trace's that can be read, the built-in one for a scenario. `maps`: "builtin", a layout's name
/// (`layout_names`), or a PNG file with or without a sidecar. `actuator`: file of an `ActuatorModel`, or empty. A map
/// that cannot be used, alone or with these motors, stays in the plan without a SHA-256, and its reason is returned.
/// Measures each map on the avatar, `jobs` maps at a time; asks `go_on` before each. Throws `Error` where no avatar or
/// no motors can be read, and where it is not to go on.
std::vector<BatchFailure> load_inputs(BatchPlan& plan, const std::string& avatar, const std::vector<std::string>& maps,
                                      const std::string& actuator, std::size_t jobs,
                                      const std::function<bool()>& go_on);

/// Traces as given on the command line: a scenario by its name, else a file. Names are theirs.
std::vector<BatchTrace> name_traces(const std::vector<std::string>& given);

}  // namespace vestige
