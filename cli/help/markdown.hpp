#pragma once

#include <string>

#include "cli/help/command_table.hpp"

namespace vestige::help {

/// Returns the Markdown page of a verb: usage, examples, arguments and flags, and the same of each of its own verbs.
std::string markdown_page(const CommandTable& verb);

/// Returns the Markdown page that leads to the pages of the verbs. It says what they share: flags, exit codes, files.
std::string markdown_index(const CommandTable& program);

/// Returns the file name of a verb's page: "record.md" for "vestige record".
std::string markdown_name(const CommandTable& verb);

}  // namespace vestige::help
