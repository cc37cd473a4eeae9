#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "cli/terminal.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige::cli {

/// The flag --facing: one of `kFacingNames`, or "auto".
struct FacingChoice {
  std::string axis = "auto";
};
CLI::Option* add_facing_option(CLI::App& verb, FacingChoice& choice);

/// `vestige::settle_facing` for --facing, without a map. Prints its warnings.
void settle_facing(Avatar& avatar, const FacingChoice& choice, const std::string& name, Verbosity verbosity);

}  // namespace vestige::cli
