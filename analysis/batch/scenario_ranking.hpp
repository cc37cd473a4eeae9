#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "analysis/batch/ranking.hpp"
#include "analysis/batch/trace_groups.hpp"

namespace vestige {

/// The ranking by the traces of one scenario alone, or by the files alone.
struct ScenarioRanking {
  std::string scenario;  ///< a name of `TraceGroups`
  std::size_t traces = 0;
  std::vector<RankedCandidate> ranking;  ///< with one metric, the headline
};

/// Ranks candidates by each group of traces alone. `headlines` has a value for each trace of each candidate. Empty if
/// there is one group only.
std::vector<ScenarioRanking> rank_by_scenario(std::span<const std::vector<double>> headlines, const TraceGroups& groups,
                                              RankDirection direction, std::uint64_t seed);

/// Returns one sentence on the scenarios whose first is worse or another over all traces: "on slide alone, paper6 with
/// gaussian is first". `names` are those of the candidates. Empty if there is no such scenario.
std::string describe_reversals(std::span<const ScenarioRanking> scenarios, std::span<const RankedCandidate> pooled,
                               std::span<const std::string> names);

}  // namespace vestige
