#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace vestige {

/// One row of the table in results/README.md: something that a result file shows, with everything needed to check it.
struct Claim {
  std::string claim;
  std::string command;
  std::string time;
  std::string machine;  ///< processor, cores, GL renderer
  std::string commit;
  std::string file;
};

/// Returns the claims that a JSON shows: a recording, replay, sweep, query, accuracy, stress, agreement or decision
/// benchmark. Returns no claims for any other JSON. `file` is the file's name in the table.
std::vector<Claim> claims_of(const nlohmann::json& result, const std::string& file);

/// Returns a results-only file combined with its run.json, which says where the results come from.
nlohmann::json with_run(nlohmann::json result, const nlohmann::json& run);

/// Returns the claims as a Markdown table.
std::string claims_table(const std::vector<Claim>& claims);

}  // namespace vestige
