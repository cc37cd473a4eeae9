#pragma once

#include <string>
#include <vector>

#include "cli/help/command_table.hpp"

namespace vestige::help {

/// What could stand in the place of the last of `words` (which follow the program's name; the last may be empty), one
/// a line: the word, a tab, what it means. A line ":" says that names of files fit too.
std::string completions(const CommandTable& program, const std::vector<std::string>& words);

/// The script that makes a shell ask `vestige complete WORDS...`. `shell`: "bash", "zsh" or "fish".
std::string completion_script(const std::string& shell);

}  // namespace vestige::help
