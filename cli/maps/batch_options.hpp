#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "analysis/batch/batch_plan.hpp"
#include "cli/choices/detectors.hpp"
#include "cli/choices/law_choice.hpp"
#include "cli/choices/motion.hpp"
#include "cli/options.hpp"

namespace vestige::cli {

/// The options that 'vestige batch' and 'vestige batch slurm' share.
struct BatchOptions {
  CommonOptions common;
  DetectorChoice choice;
  std::vector<std::string> maps;
  std::vector<std::string> traces;
  std::string laws;
  LawFlags law_parameters;  ///< for all laws
  std::string avatar;
  MorphChoice morphs;
  std::string rank_by;  ///< empty: see `rank_by_of`
  std::optional<double> unfelt_mm;
  std::optional<double> rate_hz;
  std::optional<double> duration_s;
  std::optional<std::uint32_t> count;
  std::string seeds;  ///< empty: --seed alone
  std::string output;
};

/// Number of lines of the ranking that are printed; its file has all lines.
inline constexpr std::size_t kRowsShown = 20;

/// Adds all of these flags. --jobs and --shard are not among them.
void add_batch_options(CLI::App& verb, BatchOptions& options);

/// Returns the plan for the options, without what must be read from files (`load_inputs`). Throws `UsageError`.
BatchPlan plan_of(const BatchOptions& options);

/// Returns the flags as words for a shell, without -o, --json, -q and -v.
std::vector<std::string> arguments_of(const BatchOptions& options);

void add_batch_merge(CLI::App& batch, Invocation& invocation);
void add_batch_slurm(CLI::App& batch, Invocation& invocation);

/// Prints the warnings about avatar and maps in run.json (`input_warnings`).
void warn_of_inputs(const nlohmann::ordered_json& run, Verbosity verbosity);

/// Returns the metric that ranks: that of --rank-by, otherwise the one that counts what is not felt if it is to count,
/// otherwise the localisation error. Throws `UsageError` if it needs --unfelt-mm.
std::string rank_by_of(const BatchOptions& options);

/// Returns the index of the metric with this name. Throws `UsageError` if there is none that can rank.
std::size_t headline_of(const std::string& rank_by);

/// Adds --rank-by.
CLI::Option* add_rank_by(CLI::App& verb, std::string& rank_by);

}  // namespace vestige::cli
