#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string_view>

namespace vestige::cli {

/// Parses the command line, and so runs the callbacks of its verbs. Returns nothing if it was understood. Otherwise
/// returns the exit code: help was asked for and printed, or the usage is wrong and a message was printed. `verbs` is
/// what the program calls its verbs: "verb". Throws `UsageError` if there is no verb, no such verb, or a value is
/// empty, and `Error` if standard output cannot be written. What the callbacks throw passes through.
std::optional<int> parse_command_line(CLI::App& program, std::string_view verbs, int argc, char** argv);

}  // namespace vestige::cli
