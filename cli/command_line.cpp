#include "cli/command_line.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <iostream>
#include <string>

#include "cli/help/suggest.hpp"
#include "cli/terminal.hpp"
#include "traces/base/error.hpp"
#include "traces/base/system_error.hpp"

namespace vestige::cli {

namespace {

/// CLI11 would take the word behind `--rate=` as its value.
void refuse_empty_values(int argc, char** argv) {
  constexpr const char* kRemedy = "a variable may be unset: leave the flag out, or give the flag a value";
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word.empty()) throw UsageError(fmt::format("argument {}", i), "is empty", kRemedy);
    if (word.starts_with('-') && word.find('=') == word.size() - 1)
      throw UsageError(word, "has no value behind the equals sign", kRemedy);
  }
}

}  // namespace

std::optional<int> parse_command_line(CLI::App& program, std::string_view verbs, int argc, char** argv) {
  refuse_empty_values(argc, argv);
  const std::string verb = argc > 1 ? argv[1] : "";
  if (verb.empty())
    throw UsageError(program.get_name(), fmt::format("no {} was named", verbs),
                     fmt::format("'{} --help' lists the verbs", program.get_name()));
  if (!verb.starts_with('-'))
    if (const auto remedy = help::unknown_verb_remedy(program, verb))
      throw UsageError(verb, fmt::format("there is no such {}", verbs), *remedy);
  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& asked_for) {
    const int shown = program.exit(asked_for);
    std::cout.flush();
    if (!std::cout) throw system_error("standard output", "could not write", errno);
    return shown;
  } catch (const CLI::ParseError& error) {
    print_message(
        fmt::format("vestige: error: {}\n  {}\n", help::cause_of(program, error), help::remedy_of(program, error)));
    return kWrongUsage;
  }
  return std::nullopt;
}

}  // namespace vestige::cli
