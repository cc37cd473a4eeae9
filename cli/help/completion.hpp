#pragma once

#include <string>
#include <vector>

#include "cli/help/command_table.hpp"

namespace vestige::help {

/// Returns the possible completions of the last of `words` (which follow the program's name; the last may be empty),
/// one on each line: the word, a tab, its meaning. A line ":" means that file names fit too.
std::string completions(const CommandTable& program, const std::vector<std::string>& words);

/// Returns the script that makes a shell call `vestige complete WORDS...`. `shell` is "bash", "zsh" or "fish".
std::string completion_script(const std::string& shell);

}  // namespace vestige::help
