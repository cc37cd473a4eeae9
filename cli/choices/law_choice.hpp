#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "detector/actuators/law_maker.hpp"

namespace vestige::cli {

/// Adds --full-speed, --sigma, --actuator and --hold to a help group. `hold_remark` follows the help of --hold.
void add_law_parameters(CLI::App& verb, LawFlags& flags, const std::string& group, const std::string& hold_remark = "");
/// Adds --law and the flags of `add_law_parameters`.
void add_law_options(CLI::App& verb, LawFlags& flags, const std::string& group, const std::string& hold_remark = "");

}  // namespace vestige::cli
