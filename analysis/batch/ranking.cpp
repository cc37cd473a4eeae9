#include "analysis/batch/ranking.hpp"

#include <algorithm>
#include <cmath>

namespace vestige {

std::vector<RankedCandidate> rank_candidates(std::span<const CandidateValues> candidates, std::size_t headline,
                                             RankDirection direction, std::uint64_t seed) {
  std::vector<RankedCandidate> ranking;
  if (candidates.empty()) return ranking;
  const PairedBootstrap bootstrap(candidates.front().at(headline).size(), seed);
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    RankedCandidate& ranked = ranking.emplace_back();
    ranked.candidate = i;
    for (const std::vector<double>& values : candidates[i]) ranked.metrics.push_back(bootstrap.mean(values));
  }
  const auto mean = [&](const RankedCandidate& ranked) { return ranked.metrics[headline].mean; };
  std::ranges::stable_sort(ranking, [&](const RankedCandidate& a, const RankedCandidate& b) {
    if (std::isnan(mean(a)) || std::isnan(mean(b))) return !std::isnan(mean(a)) && std::isnan(mean(b));
    return direction == RankDirection::kLowerIsBetter ? mean(a) < mean(b) : mean(a) > mean(b);
  });
  const std::vector<double>& best = candidates[ranking.front().candidate][headline];
  for (std::size_t i = 0; i < ranking.size(); ++i) {
    RankedCandidate& ranked = ranking[i];
    if (std::isnan(mean(ranked))) continue;
    ranked.rank = i > 0 && mean(ranking[i - 1]) == mean(ranked) ? *ranking[i - 1].rank : i + 1;
    ranked.difference_from_best = bootstrap.difference(candidates[ranked.candidate][headline], best);
    const Interval& interval = ranked.difference_from_best.interval;
    ranked.distinguishable_from_best = interval.low > 0 || interval.high < 0;
  }
  return ranking;
}

}  // namespace vestige
