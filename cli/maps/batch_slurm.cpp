#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "analysis/batch/slurm_script.hpp"
#include "cli/help/validators.hpp"
#include "cli/maps/batch_options.hpp"
#include "cli/verbs.hpp"
#include "traces/base/error.hpp"
#include "traces/base/number_text.hpp"

namespace vestige::cli {

namespace {

struct BatchSlurmOptions {
  BatchOptions batch;
  std::size_t shards = 0;
  std::size_t jobs = 1;
  std::vector<std::string> sbatch;
};

void run_slurm(const BatchSlurmOptions& options) {
  const BatchPlan plan = plan_of(options.batch);
  if (!options.batch.common.json.empty())
    throw UsageError("--json", "'vestige batch slurm' writes a script only", "leave it out");
  if (options.shards > plan.traces.size())
    throw UsageError("--shards",
                     fmt::format("{} for {}: some shards would have no trace", counted(options.shards, "shard"),
                                 counted(plan.traces.size(), "trace")),
                     fmt::format("make at most {}", counted(plan.traces.size(), "shard")));
  SlurmBatch batch;
  batch.program = std::filesystem::read_symlink("/proc/self/exe").string();
  batch.working_folder = std::filesystem::current_path().string();
  batch.arguments = arguments_of(options.batch);
  batch.output = std::filesystem::absolute(options.batch.output).lexically_normal().string();
  batch.shards = options.shards;
  batch.jobs = options.jobs;
  batch.merge_arguments = {"--rank-by", rank_by_of(options.batch)};
  if (options.batch.common.force) batch.merge_arguments.emplace_back("--force");
  batch.sbatch = options.sbatch;
  fmt::print("{}", slurm_script(batch));
}

}  // namespace

void add_batch_slurm(CLI::App& batch, Invocation& invocation) {
  static_cast<void>(invocation);
  auto options = std::make_shared<BatchSlurmOptions>();
  CLI::App* verb = add_verb(
      batch, "slurm", "Print a script that runs a batch as a Slurm job array, and merges its shards",
      "  vestige batch slurm --shards 3 --maps paper6 body --traces swarm hug slide -o compared >submit.sh\n"
      "  vestige batch slurm --shards 2 --maps paper6 --traces swarm hug --sbatch=--time=60 -o c >submit.sh\n");
  verb->add_option("--shards", options->shards, "Number of shards, each of which is one job")
      ->required()
      ->check(help::whole_number(1, 1000000))
      ->type_name("N");
  verb->add_option("--jobs", options->jobs, "Processors of each shard")
      ->capture_default_str()
      ->check(help::whole_number(1, 1024))
      ->type_name("N");
  verb->add_option("--sbatch", options->sbatch, "A further option of sbatch, as in --sbatch=--partition=short")
      ->allow_extra_args(false)
      ->type_name("OPTION");
  add_batch_options(*verb, options->batch);
  verb->callback([options] { run_slurm(*options); });
}

}  // namespace vestige::cli
