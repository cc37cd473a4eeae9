#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "detector/actuators/law_maker.hpp"

namespace vestige::cli {

/// Adds --full-speed, --sigma, --actuator and --hold to a group of help.
void add_law_parameters(CLI::App& verb, LawFlags& flags, const std::string& group, const std::string& hold_description);
/// Adds --law, and these.
void add_law_options(CLI::App& verb, LawFlags& flags, const std::string& group, const std::string& hold_description);

}  // namespace vestige::cli
