#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace vestige {

/// One row of the table in results/README.md: something that a result file shows, with all it takes to check it.
struct Claim {
  std::string claim;
  std::string command;
  std::string time;
  std::string machine;  ///< processor, cores, GL renderer
  std::string commit;
  std::string file;
};

/// What the JSON of a recording, replay, sweep, query, accuracy, stress, agreement or decision benchmark shows; nothing
/// for any other JSON. `file` is how the table names it.
std::vector<Claim> claims_of(const nlohmann::json& result, const std::string& file);

/// A file that holds results only, with what its run.json says of where they come from.
nlohmann::json with_run(nlohmann::json result, const nlohmann::json& run);

/// The claims as a Markdown table.
std::string claims_table(const std::vector<Claim>& claims);

}  // namespace vestige
