#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "traces/base/error.hpp"

namespace vestige {

/// A JSON file that a verb or a benchmark wrote.
struct Result {
  std::string path;  ///< as it was opened: errors name it
  std::string file;  ///< the same below the folder of results: links name it
  nlohmann::json json;
};

enum class ResultKind {
  kOther,  ///< not ours, or it does not say where it comes from
  kSweep,
  kGrowth,
  kRecord,
  kReplay,
  kQuery,
  kAccuracy,
  kStress,
  kAgreement,          ///< the deciding code against the slow truth
  kGeometryAgreement,  ///< detectors against `cpu`
  kExactness,          ///< what exact decisions cost
};

ResultKind kind_of(const nlohmann::json& result);

/// Returns a results-only file combined with its run.json, which says where the results come from.
nlohmann::json with_run(nlohmann::json result, const nlohmann::json& run);

/// Returns the error that says which file lacks what.
Error not_ours(const std::string& path, const nlohmann::json::exception& exception);

/// Calls `read` with the JSON and the file's name of each result of this kind. Throws `Error` if a field is missing.
template <typename Read>
void for_each(ResultKind kind, const std::vector<Result>& results, Read read) {
  for (const Result& result : results) try {
      if (kind_of(result.json) == kind) read(result.json, result.file);
    } catch (const nlohmann::json::exception& exception) {
      throw not_ours(result.path, exception);
    }
}

}  // namespace vestige
