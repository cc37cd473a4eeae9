#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace vestige::help {

/// Returns the name in `names` that `word` probably means: the first name with the fewest changed letters, at most two
/// and fewer than half of the name's letters (of two letters, one). Neighbours that changed places are one change, and
/// capitals are none. Returns an empty text if there is none.
std::string_view nearest_name(std::string_view word, std::span<const std::string_view> names);

/// As above, in the form "did you mean 'NAME'? ", or an empty text; for the beginning of a remedy.
std::string did_you_mean(std::string_view word, std::span<const std::string_view> names);

/// Returns the remedy for a `word` that is not a verb of the program; empty if it is one.
std::optional<std::string> unknown_verb_remedy(const CLI::App& program, const std::string& word);

/// Returns what is wrong with the command line. CLI11 would report a missing flag before an unknown one, although the
/// unknown flag may be the missing flag, misspelt.
std::string cause_of(const CLI::App& program, const CLI::ParseError& error);

/// Returns what to do after a command line that was not understood: name the flag once, write its value, or take the
/// flag of the named verb that an unknown flag probably means, and read the verb's help.
std::string remedy_of(const CLI::App& program, const CLI::ParseError& error);

}  // namespace vestige::help
