#include "analysis/batch/rank_by.hpp"

#include <algorithm>

#include "analysis/scoring/scores.hpp"

namespace vestige {

const char* default_metric_to_rank_by() {
  return "localisation_error_mm";
}

std::vector<std::string> names_to_rank_by() {
  std::vector<std::string> names;
  for (const Metric& metric : metrics())
    if (metric.better != Better::kNeither) names.emplace_back(metric.name);
  return names;
}

std::size_t metric_to_rank_by(const std::string& name) {
  return static_cast<std::size_t>(std::ranges::find(metrics(), name, &Metric::name) - metrics().begin());
}

}  // namespace vestige
