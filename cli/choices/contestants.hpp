#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "analysis/frequency/sweep.hpp"
#include "cli/choices/detectors.hpp"
#include "cli/terminal.hpp"

namespace vestige::cli {

/// The flags of verbs that measure detectors against each other: lists, where a single one is chosen elsewhere.
struct ContestantChoice {
  DetectorChoice choice;  ///< what all have in common; its detector, context and skip are not looked at
  std::string detectors;
  std::string contexts;
  std::string skips;
  std::string renderer = "off";
};

/// Adds --detector, --context and what `add_detector_options` adds, --skip as a list.
void add_contestant_options(CLI::App& verb, ContestantChoice& choice);

/// Throws `UsageError` for a list that names what there is not, or something twice.
void check_contestant_choice(const ContestantChoice& choice);

/// Every detector asked for, those of OpenGL once in every context that this machine has, those that can skip with
/// every setting of it, and all once more beside a renderer where one is asked for. A context or a library that the
/// machine lacks is said, with `verbosity`; throws `Error` where nothing remains. They keep references to avatar and
/// map.
std::vector<Contestant> make_contestants(const ContestantChoice& choice, const Avatar& avatar, const ActuatorMap& map,
                                         Verbosity verbosity);

}  // namespace vestige::cli
