#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "analysis/batch/batch_plan.hpp"
#include "cli/choices/detectors.hpp"
#include "cli/choices/law_choice.hpp"
#include "cli/options.hpp"

namespace vestige::cli {

/// What 'vestige batch' and 'vestige batch slurm' are told alike.
struct BatchOptions {
  CommonOptions common;
  DetectorChoice choice;
  std::vector<std::string> maps;
  std::vector<std::string> traces;
  std::string laws;
  LawFlags law_parameters;  ///< of all laws alike
  std::string avatar;
  std::string rank_by;
  std::optional<double> rate_hz;
  std::optional<double> duration_s;
  std::optional<std::uint32_t> count;
  std::string output;
};

/// Lines of the ranking that are printed; its file has them all.
inline constexpr std::size_t kRowsShown = 20;

/// Adds all of them but --jobs and --shard.
void add_batch_options(CLI::App& verb, BatchOptions& options);

/// The plan that they make, but for what must be read from files (`load_inputs`). Throws `UsageError`.
BatchPlan plan_of(const BatchOptions& options);

/// The same flags again, as words for a shell: without -o, and without those that change no result.
std::vector<std::string> arguments_of(const BatchOptions& options);

void add_batch_merge(CLI::App& batch, Invocation& invocation);
void add_batch_slurm(CLI::App& batch, Invocation& invocation);

/// Warns of what run.json says about avatar and maps (`input_warnings`).
void warn_of_inputs(const nlohmann::ordered_json& run, Verbosity verbosity);

/// Adds --rank-by.
CLI::Option* add_rank_by(CLI::App& verb, std::string& rank_by);

}  // namespace vestige::cli
