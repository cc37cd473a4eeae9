#pragma once

#include <CLI/CLI.hpp>

#include "cli/options.hpp"

namespace vestige::cli {

// One function for each verb, in a file with the verb's name. The function adds the verb to the program. Parsing the
// verb runs it.
void add_record(CLI::App& program, Invocation& invocation);
void add_replay(CLI::App& program, Invocation& invocation);
void add_view(CLI::App& program, Invocation& invocation);
void add_viz(CLI::App& program, Invocation& invocation);
void add_sweep(CLI::App& program, Invocation& invocation);
void add_growth(CLI::App& program, Invocation& invocation);
void add_compare(CLI::App& program, Invocation& invocation);
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
void add_live(CLI::App& program, Invocation& invocation);
void add_vest(CLI::App& program, Invocation& invocation);
void add_explain(CLI::App& program, Invocation& invocation);
void add_avatar(CLI::App& program, Invocation& invocation);
void add_map(CLI::App& program, Invocation& invocation);
void add_devices(CLI::App& program, Invocation& invocation);
void add_plot(CLI::App& program, Invocation& invocation);
void add_claims(CLI::App& program, Invocation& invocation);
void add_completion(CLI::App& program, Invocation& invocation);
void add_man(CLI::App& program, Invocation& invocation);

/// The help group of the verbs that serve the shell.
inline constexpr const char* kShellVerbs = "For the shell";

/// Adds a verb. `examples` are two examples that run as they are; they open the verb's help.
CLI::App* add_verb(CLI::App& program, const std::string& name, const std::string& summary, const std::string& examples);

/// Prints the completions of the last of `words`, which follow the program's name. Returns the exit code.
int complete(const CLI::App& program, const std::vector<std::string>& words);

/// Runs `vestige-plot` with these arguments and returns its exit code. Throws `Error` if it is not installed.
int run_plot(const std::vector<std::string>& arguments);

/// Draws the results that a verb has just written to `folder`, as 'vestige plot KIND' does. A failure is only a
/// warning, because the results exist. If no figure is wanted, removes the one that an earlier run left: NAME.png,
/// NAME.svg.
void draw_or_remove_figure(const std::string& kind, const std::string& name, const std::string& folder, bool wanted,
                           const CommonOptions& options);

}  // namespace vestige::cli
