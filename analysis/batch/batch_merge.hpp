#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace vestige {

/// The checked shards of one batch: all are there and finished, with the same inputs and the same program.
struct MergedShards {
  nlohmann::ordered_json batch;  ///< "batch" of run.json, the same for all shards
  std::string rank_by;           ///< the first shard's metric to rank by
  nlohmann::ordered_json runs;   ///< each shard's run.json, in order
  /// The first shard's folder. Its avatar, motors and maps are as they were judged.
  std::string first_folder;
  std::vector<std::string> folder_of_trace;  ///< folder for each trace of the batch; empty: the trace could not be used
  std::vector<nlohmann::ordered_json> items;  ///< items of the usable traces, in order
  nlohmann::ordered_json failures;            ///< maps first, then traces in order; each failure once
};

/// Reads the folders that 'vestige batch --shard' wrote, in any order. A shard may occur twice if both folders have the
/// same results. Throws `Error` with folder, cause and remedy if a folder has no batch, is not finished, or comes from
/// other inputs, options or another program; if a shard is missing; if results differ; or if files were changed since.
MergedShards read_shards(const std::vector<std::string>& folders);

}  // namespace vestige
