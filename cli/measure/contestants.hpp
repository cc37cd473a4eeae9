#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "analysis/frequency/sweep.hpp"
#include "cli/choices/detectors.hpp"
#include "cli/terminal.hpp"

namespace vestige::cli {

/// The flags of verbs that compare detectors: lists, where other verbs choose a single detector.
struct ContestantChoice {
  DetectorChoice choice;  ///< the common options; its detector, context and skip are not used
  std::string detectors;
  std::string contexts;
  std::string skips;
  std::string planes = "1";
  std::string renderer = "off";
};

/// Adds --detector, --context and the flags of `add_detector_options`, with --skip as a list.
void add_contestant_options(CLI::App& verb, ContestantChoice& choice);

/// Throws `UsageError` if a list has an unknown entry, or the same entry twice.
void check_contestant_choice(const ContestantChoice& choice);

/// Makes the detectors by whose contacts `run_sweep` chooses frames.
ContestantMaker survey_maker(const ContestantChoice& choice);

/// Returns every requested detector: those of OpenGL once in every requested context that this machine has, those that
/// can skip with every requested setting of --skip, and `paper` with every requested number of planes. If a renderer is
/// requested, each detector runs a second time beside it. Reports a context or a library that the machine lacks, by
/// `verbosity`. Throws `Error` if no detector remains, or if a requested device cannot be used.
std::vector<Contestant> make_contestants(const ContestantChoice& choice, Verbosity verbosity);

}  // namespace vestige::cli
