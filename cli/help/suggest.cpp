#include "cli/help/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <vector>

namespace vestige::help {

namespace {

/// Levenshtein's distance: letters put in, left out or exchanged.
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t k = 0; k < b.size(); ++k) {
      const std::size_t exchanged = diagonal + (a[i] == b[k] ? 0 : 1);
      diagonal = row[k + 1];
      row[k + 1] = std::min({exchanged, row[k] + 1, diagonal + 1});
    }
  }
  return row.back();
}

}  // namespace

std::string_view nearest_name(std::string_view word, std::span<const std::string_view> names) {
  std::string_view nearest;
  std::size_t fewest = 3;
  for (const std::string_view name : names) {
    const std::size_t changes = distance(word, name);
    if (changes >= fewest || 2 * changes >= name.size()) continue;
    fewest = changes;
    nearest = name;
  }
  return nearest;
}

std::string did_you_mean(std::string_view word, std::span<const std::string_view> names) {
  const std::string_view nearest = nearest_name(word, names);
  return nearest.empty() ? "" : fmt::format("did you mean '{}'? ", nearest);
}

std::optional<std::string> unknown_verb_remedy(const CLI::App& program, const std::string& word) {
  const auto verbs = program.get_subcommands([](const CLI::App*) { return true; });
  std::vector<std::string> names;
  names.reserve(verbs.size());
  for (const CLI::App* verb : verbs) names.push_back(verb->get_name());
  if (std::ranges::find(names, word) != names.end()) return std::nullopt;
  return fmt::format("{}'{} --help' lists the verbs",
                     did_you_mean(word, std::vector<std::string_view>(names.begin(), names.end())), program.get_name());
}

std::string cause_of(const CLI::App& program, const CLI::ParseError& error) {
  constexpr std::string_view kOverride = " was given a disallowed flag override";  // CLI11's words
  if (const std::string cause = error.what(); cause.ends_with(kOverride))
    return fmt::format("--{} takes no value", cause.substr(0, cause.size() - kOverride.size()));
  const bool is_missing = error.get_name() == "RequiredError" || error.get_name() == "RequiresError";
  if (!is_missing || program.remaining_size(true) == 0) return error.what();
  return CLI::ExtrasError(program.remaining(true)).what();
}

std::string help_remedy(const CLI::App& program) {
  std::string name = program.get_name();
  const CLI::App* verb = &program;
  while (!verb->get_subcommands().empty()) {
    verb = verb->get_subcommands().front();
    name += " " + verb->get_name();
  }
  return fmt::format("'{} --help' {}", name, verb == &program ? "lists the verbs" : "explains the verb");
}

}  // namespace vestige::help
