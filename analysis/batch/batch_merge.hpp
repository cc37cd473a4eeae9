#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace vestige {

/// The shards of one batch, checked: all there, finished, of the same inputs and program.
struct MergedShards {
  nlohmann::ordered_json batch;               ///< what all of their run.json say
  std::string rank_by;                        ///< of the first shard
  nlohmann::ordered_json runs;                ///< each shard's run.json, in order
  std::string first_folder;                   ///< whose avatar, motors and maps are as they were judged
  std::vector<std::string> folder_of_trace;   ///< for each trace of the batch; empty: it could not be used
  std::vector<nlohmann::ordered_json> items;  ///< of those that could, in order
  nlohmann::ordered_json failures;            ///< maps first, then traces in order; each once
};

/// Reads the folders that 'vestige batch --shard' wrote, in any order; the same shard may be there twice, if both came
/// to the same. Throws `Error` naming folder, cause and remedy: no batch, not finished, of other inputs, options or
/// another program, a shard that is missing, differing results, files that were changed since.
MergedShards read_shards(const std::vector<std::string>& folders);

}  // namespace vestige
