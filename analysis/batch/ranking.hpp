#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "analysis/base/statistics.hpp"

namespace vestige {

/// Over fewer, intervals are rough.
constexpr std::size_t kFewTraces = 10;

/// One candidate's values of each metric: [metric][trace]. NaN: the metric has no value there (nothing was felt, …).
using CandidateValues = std::vector<std::vector<double>>;

enum class RankDirection { kHigherIsBetter, kLowerIsBetter };

/// Where a candidate stands among the others.
struct RankedCandidate {
  std::size_t candidate = 0;               ///< as given
  std::optional<std::size_t> rank;         ///< from 1; equal headlines share one; none: it has no value on any trace
  std::vector<MeanInterval> metrics;       ///< over the traces, of each metric
  MeanInterval difference_from_best;       ///< headline minus that of the first, over the traces that both have
  bool distinguishable_from_best = false;  ///< the 95 % interval of that difference leaves out 0
};

/// Ranks candidates by the mean of metric `headline` over the traces, best first, ties in the order given. Intervals:
/// `PairedBootstrap` over the traces, since all candidates saw the same ones; each comparison stands at 95 % for
/// itself, not corrected for how many there are. With fewer than two common traces nothing is distinguishable.
std::vector<RankedCandidate> rank_candidates(std::span<const CandidateValues> candidates, std::size_t headline,
                                             RankDirection direction, std::uint64_t seed);

}  // namespace vestige
