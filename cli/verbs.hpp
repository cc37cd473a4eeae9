#pragma once

#include <CLI/CLI.hpp>

#include "cli/options.hpp"

namespace vestige::cli {

// One function a verb, in a file of its name: adds the verb to the program; parsing it runs it.
void add_record(CLI::App& program, Invocation& invocation);
void add_replay(CLI::App& program, Invocation& invocation);
void add_sweep(CLI::App& program, Invocation& invocation);
void add_inspect(CLI::App& program, Invocation& invocation);
void add_avatar(CLI::App& program, Invocation& invocation);
void add_devices(CLI::App& program, Invocation& invocation);
void add_plot(CLI::App& program, Invocation& invocation);
void add_claims(CLI::App& program, Invocation& invocation);

/// Makes a verb. `examples`, two that run as they are, open its help.
CLI::App* add_verb(CLI::App& program, const std::string& name, const std::string& summary, const std::string& examples);

/// Runs `vestige-plot` with these arguments and returns its exit code; throws `Error` where it is not installed.
int run_plot(const std::vector<std::string>& arguments);

}  // namespace vestige::cli
