#pragma once

#include <cstddef>
#include <string>

namespace vestige {

/// What candidates are put in order by, unless told otherwise.
const char* default_metric_to_rank_by();

/// Of `metrics()`, the one of that name. Throws `UsageError` naming --rank-by and listing them, those that no value is
/// better of left out.
std::size_t metric_to_rank_by(const std::string& name);

}  // namespace vestige
