#include "analysis/batch/scenario_ranking.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "traces/base/number_text.hpp"

namespace vestige {

namespace {

/// Returns the candidates of rank 1.
std::vector<std::size_t> firsts(std::span<const RankedCandidate> ranking) {
  std::vector<std::size_t> candidates;
  for (const RankedCandidate& ranked : ranking)
    if (ranked.rank == 1U) candidates.push_back(ranked.candidate);
  return candidates;
}

}  // namespace

std::vector<ScenarioRanking> rank_by_scenario(std::span<const std::vector<double>> headlines, const TraceGroups& groups,
                                              RankDirection direction, std::uint64_t seed) {
  std::vector<ScenarioRanking> scenarios;
  if (groups.names.size() < 2) return scenarios;
  scenarios.reserve(groups.names.size());
  for (std::size_t g = 0; g < groups.names.size(); ++g) {
    std::vector<CandidateValues> values(headlines.size(), CandidateValues(1));
    std::size_t traces = 0;
    for (std::size_t trace = 0; trace < groups.of_trace.size(); ++trace) {
      if (groups.of_trace[trace] != g) continue;
      ++traces;
      for (std::size_t c = 0; c < headlines.size(); ++c) values[c][0].push_back(headlines[c][trace]);
    }
    const std::vector<std::size_t> alike(traces, 0);
    scenarios.push_back({groups.names[g], traces, rank_candidates(values, alike, 0, direction, seed)});
  }
  return scenarios;
}

std::string describe_reversals(std::span<const ScenarioRanking> scenarios, std::span<const RankedCandidate> pooled,
                               std::span<const std::string> names) {
  const std::vector<std::size_t> best = firsts(pooled);
  std::vector<std::pair<std::size_t, std::vector<std::string>>> reversals;  // another first, and the scenarios of it
  for (const ScenarioRanking& scenario : scenarios) {
    const std::vector<std::size_t> first = firsts(scenario.ranking);
    if (first.empty() || std::ranges::any_of(first, [&](std::size_t c) { return std::ranges::count(best, c) != 0; }))
      continue;
    const auto known = std::ranges::find(reversals, first.front(), &decltype(reversals)::value_type::first);
    if (known == reversals.end())
      reversals.push_back({first.front(), {scenario.scenario}});
    else
      known->second.push_back(scenario.scenario);
  }
  std::vector<std::string> parts;
  parts.reserve(reversals.size());
  for (const auto& [candidate, where] : reversals)
    parts.push_back(fmt::format("on {} alone, {} is first", listed(where), names[candidate]));
  return fmt::format("{}", fmt::join(parts, "; "));
}

}  // namespace vestige
