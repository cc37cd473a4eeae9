#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace vestige::help {

/// Which of `names` was probably meant by `word`: the first that is fewest changes of a letter away, two at most and
/// fewer than half of its letters. Empty where there is none.
std::string_view nearest_name(std::string_view word, std::span<const std::string_view> names);

/// The same as "did you mean 'NAME'? ", or nothing, for the beginning of a remedy.
std::string did_you_mean(std::string_view word, std::span<const std::string_view> names);

/// What to do about a `word` that is none of the program's verbs; nothing where it is one.
std::optional<std::string> unknown_verb_remedy(const CLI::App& program, const std::string& word);

/// What is wrong with the command line. CLI11 would speak of a flag that is missing before one that it does not know,
/// although they may be the same, misspelt.
std::string cause_of(const CLI::App& program, const CLI::ParseError& error);

/// Which help to read about a command line that was not understood: the one of the verb that was named.
std::string help_remedy(const CLI::App& program);

}  // namespace vestige::help
