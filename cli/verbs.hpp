#pragma once

#include <CLI/CLI.hpp>

#include "cli/options.hpp"

namespace vestige::cli {

// One function a verb, in a file of its name: adds the verb to the program; parsing it runs it.
void add_record(CLI::App& program, Invocation& invocation);
void add_replay(CLI::App& program, Invocation& invocation);
void add_sweep(CLI::App& program, Invocation& invocation);
void add_growth(CLI::App& program, Invocation& invocation);
void add_query(CLI::App& program, Invocation& invocation);
void add_stress(CLI::App& program, Invocation& invocation);
void add_accuracy(CLI::App& program, Invocation& invocation);
void add_batch(CLI::App& program, Invocation& invocation);
void add_inspect(CLI::App& program, Invocation& invocation);
void add_doctor(CLI::App& program, Invocation& invocation);
void add_recover(CLI::App& program, Invocation& invocation);
void add_recompress(CLI::App& program, Invocation& invocation);
void add_trim(CLI::App& program, Invocation& invocation);
void add_merge(CLI::App& program, Invocation& invocation);
void add_export(CLI::App& program, Invocation& invocation);
void add_import(CLI::App& program, Invocation& invocation);
void add_cat(CLI::App& program, Invocation& invocation);
void add_stream(CLI::App& program, Invocation& invocation);
void add_vest(CLI::App& program, Invocation& invocation);
void add_avatar(CLI::App& program, Invocation& invocation);
void add_map(CLI::App& program, Invocation& invocation);
void add_devices(CLI::App& program, Invocation& invocation);
void add_plot(CLI::App& program, Invocation& invocation);
void add_claims(CLI::App& program, Invocation& invocation);
void add_completion(CLI::App& program, Invocation& invocation);
void add_man(CLI::App& program, Invocation& invocation);

/// The group of the verbs that serve the shell.
inline constexpr const char* kShellVerbs = "For the shell";

/// Makes a verb. `examples`, two that run as they are, open its help.
CLI::App* add_verb(CLI::App& program, const std::string& name, const std::string& summary, const std::string& examples);

/// Prints what could complete the last of `words`, which follow the program's name, and returns the exit code.
int complete(const CLI::App& program, const std::vector<std::string>& words);

/// Runs `vestige-plot` with these arguments and returns its exit code; throws `Error` where it is not installed.
int run_plot(const std::vector<std::string>& arguments);

/// Draws what a verb has just written into `folder`, as 'vestige plot KIND' does. What fails is only a warning: the
/// results are there. Where no figure is wanted, one that an earlier run left goes: NAME.png, NAME.svg.
void draw_or_remove_figure(const std::string& kind, const std::string& name, const std::string& folder, bool wanted,
                           const CommonOptions& options);

}  // namespace vestige::cli
