#pragma once

#include <functional>
#include <string>
#include <vector>

#include "analysis/batch/batch_plan.hpp"

namespace vestige {

/// Reads a batch's avatar, maps and motors into `plan`. The traces of `plan` must already be named. `avatar` is
/// "builtin", a file, or empty. If it is empty, the avatar is that of the first readable trace, and the built-in one
/// for a scenario. `maps` holds "builtin", names of layouts (`layout_names`), or PNG files with or without a sidecar.
/// `actuator` is the file of an `ActuatorModel`, or empty. Measures each map on the avatar, `jobs` maps at a time, and
/// asks `go_on` before each. A map that cannot be used, alone or with these motors, stays in the plan without a
/// SHA-256. Returns the reasons of such maps. Throws `Error` if avatar or motors cannot be read, or if `go_on` returns
/// false.
std::vector<BatchFailure> load_inputs(BatchPlan& plan, const std::string& avatar, const std::vector<std::string>& maps,
                                      const std::string& actuator, std::size_t jobs,
                                      const std::function<bool()>& go_on);

/// Returns named traces from the command line's words. A word is a scenario's name, otherwise a file. Each scenario is
/// there once for each of the seeds, and a file of several people once for each of them. The name of the trace is made
/// of the word, and of the seed or of the person's number if there are several. A file that cannot be read is there
/// once.
std::vector<BatchTrace> name_traces(const std::vector<std::string>& given, const std::vector<std::uint64_t>& seeds);

}  // namespace vestige
