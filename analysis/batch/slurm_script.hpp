#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace vestige {

/// A batch for Slurm.
struct SlurmBatch {
  std::string program;         ///< absolute path of vestige
  std::string working_folder;  ///< absolute; relative paths of the inputs begin here
  /// Arguments of 'vestige batch': inputs and options, without --shard, --jobs and -o.
  std::vector<std::string> arguments;
  std::string output;  ///< -o
  std::size_t shards = 1;
  std::size_t jobs = 1;  ///< processors for each shard
  std::vector<std::string> merge_arguments;
  std::vector<std::string> sbatch;  ///< further options of sbatch, such as "--time=60"
};

/// Returns a bash script that submits a job array with a job for each shard, and a job that merges the shards once all
/// have succeeded. A shard that is killed, preempted or near its time limit is queued again and continues where it was.
/// To submit the script again continues what failed. Shards lie in OUTPUT/shards, logs in OUTPUT/logs.
std::string slurm_script(const SlurmBatch& batch);

/// Returns `text` quoted as one shell word.
std::string shell_quoted(const std::string& text);

}  // namespace vestige
