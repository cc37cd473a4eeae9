#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "analysis/base/statistics.hpp"

namespace vestige {

/// With fewer traces than this, intervals are rough.
constexpr std::size_t kFewTraces = 10;

/// One candidate's values of each metric: [metric][trace]. NaN: the metric has no value on that trace (nothing was
/// felt, …).
using CandidateValues = std::vector<std::vector<double>>;

enum class RankDirection { kHigherIsBetter, kLowerIsBetter };

/// The place of a candidate among the others.
struct RankedCandidate {
  std::size_t candidate = 0;  ///< index in the given order
  /// From 1. Equal headlines share a rank. None: the candidate has no headline value on any trace.
  std::optional<std::size_t> rank;
  std::vector<MeanInterval> metrics;       ///< mean over the traces, for each metric
  MeanInterval difference_from_best;       ///< headline minus the headline of the first, over the traces that both have
  bool distinguishable_from_best = false;  ///< the 95 % interval of that difference does not include 0
};

/// Ranks candidates by the mean of metric `headline` over the traces, best first. Ties keep the given order. Intervals
/// come from `PairedBootstrap` over the traces, since all candidates saw the same traces. Each comparison has 95 % by
/// itself, without correction for the number of comparisons. With fewer than two common traces, no candidate is
/// distinguishable.
std::vector<RankedCandidate> rank_candidates(std::span<const CandidateValues> candidates, std::size_t headline,
                                             RankDirection direction, std::uint64_t seed);

}  // namespace vestige
