#include "analysis/batch/ranking.hpp"

#include <algorithm>
#include <cmath>

namespace vestige {

std::vector<RankedCandidate> rank_candidates(std::span<const CandidateValues> candidates,
                                             std::span<const std::size_t> stratum_of_trace, std::size_t headline,
                                             RankDirection direction, std::uint64_t seed) {
  std::vector<RankedCandidate> ranking;
  if (candidates.empty()) return ranking;
  const StratifiedBootstrap bootstrap(stratum_of_trace, seed);
  std::vector<std::vector<double>> headlines;
  headlines.reserve(candidates.size());
  ranking.reserve(candidates.size());
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    RankedCandidate& ranked = ranking.emplace_back();
    ranked.candidate = i;
    for (const std::vector<double>& values : candidates[i]) ranked.metrics.push_back(bootstrap.mean(values));
    headlines.push_back(candidates[i][headline]);
  }
  const double sign = direction == RankDirection::kLowerIsBetter ? 1 : -1;
  const auto tests = bootstrap.against_leader(headlines, sign);
  const auto mean = [&](const RankedCandidate& ranked) { return ranked.metrics[headline].mean; };
  std::ranges::stable_sort(ranking, [&](const RankedCandidate& a, const RankedCandidate& b) {
    if (std::isnan(mean(a)) || std::isnan(mean(b))) return !std::isnan(mean(a)) && std::isnan(mean(b));
    return sign * mean(a) < sign * mean(b);
  });
  for (std::size_t i = 0; i < ranking.size(); ++i) {
    RankedCandidate& ranked = ranking[i];
    if (std::isnan(mean(ranked))) continue;
    const bool ties = i > 0 && mean(ranking[i - 1]) == mean(ranked);
    ranked.rank = ties ? *ranking[i - 1].rank : i + 1;
    ranked.against_leader = tests[ranked.candidate];
  }
  return ranking;
}

}  // namespace vestige
