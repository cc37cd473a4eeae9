#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace vestige {

/// Returns the metric that candidates are ranked by unless the user names another.
const char* default_metric_to_rank_by();

/// Returns the names of the metrics that have a better direction.
std::vector<std::string> names_to_rank_by();

/// Returns the index in `metrics()` of the metric `name`. Precondition: it is one of `names_to_rank_by`.
std::size_t metric_to_rank_by(const std::string& name);

}  // namespace vestige
