#pragma once

#include <array>
#include <string>
#include <utility>

#include "cli/help/command_table.hpp"

namespace vestige::help {

/// The exit codes, which scripts may rely on.
inline constexpr std::array<std::pair<int, const char*>, 5> kExitCodes = {{
    {0, "done"},
    {1, "failed"},
    {2, "wrong usage"},
    {3,
     "done, but some data is missing (a damaged trace, an interruption, a vest that did not confirm every frame, or a "
     "figure without its PNG)"},
    {4, "a check failed"},
}};

/// The environment variables that the program reads, and what each does.
inline constexpr std::array<std::pair<const char*, const char*>, 1> kEnvironment = {{
    {"NO_COLOR", "If it is set, progress bars on a terminal have no colour."},
}};

/// Returns a man page of section 1 (roff with the man macros). Verbs of `command` without a page of their own are
/// described on it. `version` is as "0.1.0"; `date` is as "2026-11-21", or empty.
enum class VerbPages { kOwn, kNone };
std::string manual_page(const CommandTable& command, VerbPages verb_pages, const std::string& version,
                        const std::string& date);

/// Returns the page of a command: "vestige-record" for "vestige record".
std::string page_name(const CommandTable& command);

}  // namespace vestige::help
