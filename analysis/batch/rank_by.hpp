#pragma once

#include <cstddef>
#include <string>

namespace vestige {

/// Returns the metric that candidates are ranked by unless the user names another.
const char* default_metric_to_rank_by();

/// Returns the index in `metrics()` of the metric `name`. Throws `UsageError` about --rank-by that lists the metrics,
/// except those without a better direction.
std::size_t metric_to_rank_by(const std::string& name);

}  // namespace vestige
