#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace vestige {

/// A batch for Slurm.
struct SlurmBatch {
  std::string program;                 ///< absolute path of vestige
  std::string working_folder;          ///< absolute: relative paths of the inputs begin there
  std::vector<std::string> arguments;  ///< of 'vestige batch': inputs and options, without --shard, --jobs and -o
  std::string output;                  ///< -o
  std::size_t shards = 1;
  std::size_t jobs = 1;  ///< processors of a shard
  std::vector<std::string> merge_arguments;
  std::vector<std::string> sbatch;  ///< further options of sbatch, "--time=60"
};

/// A bash script that submits a job array, a job for each shard, and a job that merges them once all have succeeded. A
/// shard that is killed, preempted or near its time limit is queued again and goes on where it was; to submit the
/// script again goes on with what failed. Shards lie in OUTPUT/shards, logs in OUTPUT/logs.
std::string slurm_script(const SlurmBatch& batch);

/// `text` as one word of a shell's.
std::string shell_quoted(const std::string& text);

}  // namespace vestige
