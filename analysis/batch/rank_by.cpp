#include "analysis/batch/rank_by.hpp"

#include <fmt/format.h>

#include <vector>

#include "analysis/scoring/scores.hpp"
#include "traces/base/error.hpp"

namespace vestige {

const char* default_metric_to_rank_by() {
  return "localisation_error_mm";
}

std::size_t metric_to_rank_by(const std::string& name) {
  std::vector<std::string> names;
  for (std::size_t m = 0; m < metrics().size(); ++m) {
    if (metrics()[m].better == Better::kNeither) continue;
    if (metrics()[m].name == name) return m;
    names.emplace_back(metrics()[m].name);
  }
  throw UsageError("--rank-by", fmt::format("there is no metric '{}' that can rank maps", name),
                   fmt::format("choose one of: {}", fmt::join(names, ", ")));
}

}  // namespace vestige
