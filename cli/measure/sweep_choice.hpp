#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "analysis/frequency/sweep.hpp"
#include "cli/measure/contestants.hpp"
#include "cli/options.hpp"

namespace vestige::cli {

/// The flags of `sweep` and of `growth`, which runs sweeps. They mean the same in both.
struct SweepChoice {
  ContestantChoice contestants;
  std::string counts;
  CommonOptions common = {};
  std::string trace = {};
  bool no_figure = false;
  std::string output = {};
  const CLI::Option* counts_option = nullptr;  ///< set by `add_swept_options`
};

/// Adds TRACE and --counts.
void add_swept_options(CLI::App& verb, SweepChoice& choice);

/// Adds --runs, --run-frames, --min-time, --no-figure, -o and the common flags.
void add_measuring_options(CLI::App& verb, SweepChoice& choice, SweepSettings& settings,
                           const std::string& run_frames_help, const std::string& output_help);

/// Copies counts and seed to `settings`. Throws `UsageError` for values that cannot be measured.
void check_sweep_choice(const SweepChoice& choice, SweepSettings& settings);

/// Leaves out the default counts that are above the trace's number of colliders. If that leaves none, all colliders are
/// measured. Counts that --counts asks for stay.
void leave_out_missing_colliders(const SweepChoice& choice, std::size_t colliders, SweepSettings& settings);

/// Makes the folder of the results, and checks the outputs (`check_outputs`) before any work is done. Returns the trace
/// to measure on: TRACE, if given. Otherwise it records trace.mcap in that folder with this many colliders.
std::string prepare_sweep(const SweepChoice& choice, std::vector<std::string> results, std::uint32_t colliders,
                          const Invocation& invocation);

/// Throws `Error` if the user stopped before there was anything to write.
void check_measured(const std::string& verb, std::span<const SweepSeries> series);

}  // namespace vestige::cli
