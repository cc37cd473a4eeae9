#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "analysis/batch/batch_folder.hpp"
#include "analysis/batch/scenario_ranking.hpp"

namespace vestige {

/// The results of every map and law, and their order. They are made of the items' own JSON. So an uninterrupted run, a
/// restarted run and merged shards give the same bytes.
struct BatchResults {
  /// A map with a law.
  struct Candidate {
    std::string map;
    std::string law;
  };
  std::vector<Candidate> candidates;
  std::vector<RankedCandidate> ranking;
  std::size_t headline = 0;  ///< index into `metrics()`
  std::size_t traces = 0;
  std::string over;                   ///< as in `TraceGroups`
  std::string why_no_intervals;       ///< as in `TraceGroups`
  std::vector<std::string> warnings;  ///< what makes the comparison unfair, one sentence each
  std::vector<ScenarioRanking> by_scenario;
  std::string reversals;  ///< as `describe_reversals` returns it

  bool has_intervals() const { return why_no_intervals.empty(); }
};

/// Writes scores.csv, scores.json, ranking.csv and ranking.json, and with several scenarios ranking_by_scenario.csv.
/// `items` are in the order of the batch's traces. Throws `Error` if an item lacks a score.
BatchResults write_results(const BatchFolder& folder, const nlohmann::ordered_json& batch,
                           std::span<const nlohmann::ordered_json> items, std::size_t headline);

/// Returns the ranking as a table of at most `rows` candidates, with notes on how to read it.
std::string describe(const BatchResults& results, std::size_t rows);

}  // namespace vestige
