#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "analysis/batch/batch_folder.hpp"
#include "analysis/batch/ranking.hpp"

namespace vestige {

/// How every finished map and law did, and their order. Made of the items' own JSON, so that a run in one go, a
/// restarted one and merged shards come to the same bytes.
struct BatchResults {
  /// One column of a ranking.
  struct Candidate {
    std::string map;
    std::string law;
  };
  std::vector<Candidate> candidates;
  std::vector<RankedCandidate> ranking;
  std::size_t headline = 0;  ///< of `metrics()`
  std::size_t traces = 0;
  std::vector<std::string> warnings;  ///< what keeps the comparison from being fair, one sentence each
};

/// Writes scores.csv, scores.json, ranking.csv and ranking.json. `items`: in the order of the batch's traces. Throws
/// `Error` for an item that lacks a score.
BatchResults write_results(const BatchFolder& folder, const nlohmann::ordered_json& batch,
                           std::span<const nlohmann::ordered_json> items, std::size_t headline);

/// The ranking as a table of at most `rows` candidates, with notes on how to read it.
std::string describe(const BatchResults& results, std::size_t rows);

}  // namespace vestige
