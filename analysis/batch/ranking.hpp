#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "analysis/base/statistics.hpp"
#include "analysis/base/stratified_bootstrap.hpp"

namespace vestige {

/// One candidate's values of each metric: [metric][trace]. NaN: the metric has no value on that trace (nothing was
/// felt, …).
using CandidateValues = std::vector<std::vector<double>>;

enum class RankDirection { kHigherIsBetter, kLowerIsBetter };

/// The place of a candidate among the others.
struct RankedCandidate {
  std::size_t candidate = 0;  ///< index in the given order
  /// From 1. Equal headlines share a rank. None: the candidate has no headline value on any trace.
  std::optional<std::size_t> rank;
  std::vector<MeanInterval> metrics;         ///< mean over the traces, for each metric
  std::optional<LeaderTest> against_leader;  ///< of the headline; none where there are too few traces to tell

  bool is_compared() const { return against_leader.has_value() && rank != 1; }
  bool is_worse() const { return is_compared() && against_leader->p_holm < 0.05; }
};

/// Ranks candidates by the mean of metric `headline` over the traces, best first. Ties keep the given order.
/// `stratum_of_trace` says which traces belong together: those of one scenario with other seeds, or all files.
/// Intervals and comparisons are those of `StratifiedBootstrap`: over other seeds of these scenarios, and over other
/// files.
std::vector<RankedCandidate> rank_candidates(std::span<const CandidateValues> candidates,
                                             std::span<const std::size_t> stratum_of_trace, std::size_t headline,
                                             RankDirection direction, std::uint64_t seed);

}  // namespace vestige
