#include "cli/help/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <numeric>
#include <vector>

#include "cli/help/command_table.hpp"

namespace vestige::help {

namespace {

bool is_same_letter(char a, char b) {
  return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
}

/// The distance of Damerau and Levenshtein: letters put in, left out or replaced, and neighbours that changed places.
/// Capitals count as small letters.
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1);  // the row before `last`
  std::vector<std::size_t> last(b.size() + 1);
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before.swap(last);
    last.swap(row);
    row[0] = i;
    for (std::size_t k = 1; k <= b.size(); ++k) {
      row[k] = std::min({last[k - 1] + (is_same_letter(a[i - 1], b[k - 1]) ? 0 : 1), row[k - 1] + 1, last[k] + 1});
      if (i > 1 && k > 1 && is_same_letter(a[i - 1], b[k - 2]) && is_same_letter(a[i - 2], b[k - 1]))
        row[k] = std::min(row[k], before[k - 2] + 1);
    }
  }
  return row.back();
}

/// How many changed letters still leave a name recognisable: fewer than half of its letters, at most two; of a name of
/// two letters, one.
std::size_t most_changes(std::string_view name) {
  if (name.size() < 3) return name.size() / 2;
  return std::min((name.size() - 1) / 2, std::size_t{2});
}

/// Returns the first flag of the command line that the named verb does not have, without its =VALUE; empty if there is
/// none.
std::string unknown_flag(const CLI::App& program) {
  for (const std::string& word : program.remaining(true))
    if (word.starts_with('-') && word.size() > 1) return word.substr(0, word.find('='));
  return {};
}

/// A flag with one value that was given several times, or without its value.
struct ValueFault {
  std::string flag;
  std::string times;  ///< how many times it was given; empty if its value is missing
};

/// Reads it from CLI11's words: "--rate: At Most 1 required but received 2", "--rate: 1 required FLOAT missing".
std::optional<ValueFault> read_value_fault(const CLI::ParseError& error) {
  constexpr std::string_view kSeveral = ": At Most 1 required but received ";
  const std::string text = error.what();
  if (const std::size_t at = text.find(kSeveral); at != std::string::npos)
    return ValueFault{.flag = text.substr(0, at), .times = text.substr(at + kSeveral.size())};
  if (const std::size_t at = text.find(": 1 required "); at != std::string::npos && text.ends_with(" missing"))
    return ValueFault{.flag = text.substr(0, at), .times = ""};
  return std::nullopt;
}

/// Whether the error is an unknown word, or follows from an unknown flag: a missing flag beside it, or an input too
/// many, which is the value of that flag.
bool is_about_unknown(const CLI::App& program, const CLI::ParseError& error) {
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError)) return true;
  if (const auto fault = read_value_fault(error);
      fault && !fault->flag.starts_with('-') && !unknown_flag(program).empty())
    return true;
  const bool is_missing = error.get_name() == "RequiredError" || error.get_name() == "RequiresError";
  return is_missing && program.remaining_size(true) > 0;
}

/// As `read_value_fault`, but an input too many that is the value of an unknown flag is no such fault.
std::optional<ValueFault> value_fault(const CLI::App& program, const CLI::ParseError& error) {
  return is_about_unknown(program, error) ? std::nullopt : read_value_fault(error);
}

/// Returns what a value that is none of a flag's values probably means. Reads it from CLI11's words: "--skip: no not in
/// {off,on}".
std::string value_hint(const CLI::ParseError& error) {
  constexpr std::string_view kNotIn = " not in {";
  const std::string text = error.what();
  const std::size_t value = text.find(": ");
  const std::size_t list = text.find(kNotIn);
  if (value == std::string::npos || list == std::string::npos || list < value + 2 || !text.ends_with('}')) return {};
  std::vector<std::string_view> names;
  std::string_view rest = std::string_view(text).substr(list + kNotIn.size());
  rest.remove_suffix(1);
  while (!rest.empty()) {
    const std::size_t comma = std::min(rest.find(','), rest.size());
    names.push_back(rest.substr(0, comma));
    rest.remove_prefix(std::min(comma + 1, rest.size()));
  }
  return did_you_mean(std::string_view(text).substr(value + 2, list - value - 2), names);
}

/// Returns the verb that the command line names; the program itself without one.
const CLI::App& named_verb(const CLI::App& program) {
  const CLI::App* verb = &program;
  while (!verb->get_subcommands().empty()) verb = verb->get_subcommands().front();
  return *verb;
}

/// Adds the names of all verbs under `verb` that have this flag.
void add_verbs_with(const std::string& flag, const CLI::App& verb, const std::string& name,
                    std::vector<std::string>& verbs) {
  if (verb.get_option_no_throw(flag) != nullptr) verbs.push_back(name);
  for (const CLI::App* part : verb.get_subcommands([](const CLI::App*) { return true; }))
    add_verbs_with(flag, *part, name.empty() ? part->get_name() : fmt::format("{} {}", name, part->get_name()), verbs);
}

/// "'record' and 'import' have it; " or an empty text.
std::string verbs_with(const std::string& flag, const CLI::App& program) {
  constexpr std::size_t kMostNamed = 4;
  std::vector<std::string> verbs;
  if (!flag.empty()) add_verbs_with(flag, program, "", verbs);
  if (verbs.empty() || verbs.size() > kMostNamed) return {};
  for (std::string& verb : verbs) verb = fmt::format("'{}'", verb);
  return fmt::format("{} {} it; ", fmt::join(verbs, ", "), verbs.size() == 1 ? "has" : "have");
}

std::vector<std::string> flags_of(const CLI::App& verb) {
  std::vector<std::string> flags;
  for (const CLI::Option* option : verb.get_options())
    for (const std::string& name : option->get_lnames()) flags.push_back("--" + name);
  return flags;
}

}  // namespace

std::string_view nearest_name(std::string_view word, std::span<const std::string_view> names) {
  std::string_view nearest;
  std::size_t fewest = 3;
  for (const std::string_view name : names) {
    const std::size_t changes = distance(word, name);
    if (changes >= fewest || changes > most_changes(name)) continue;
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
  if (const auto fault = value_fault(program, error))
    return fault->times.empty() ? fmt::format("{}: its value is missing", fault->flag)
                                : fmt::format("{}: is given {} times", fault->flag, fault->times);
  if (!is_about_unknown(program, error)) return error.what();
  if (const std::string flag = unknown_flag(program); !flag.empty()) return fmt::format("there is no flag '{}'", flag);
  return fmt::format("not expected: '{}'", fmt::join(program.remaining(true), "', '"));
}

std::string remedy_of(const CLI::App& program, const CLI::ParseError& error) {
  const CLI::App& verb = named_verb(program);
  const CommandTable table = command_table(verb);
  if (const auto fault = value_fault(program, error)) {
    if (!fault->times.empty()) return "name it once";
    for (const FlagTable& flag : table.flags)
      if (std::ranges::find(flag.names, fault->flag) != flag.names.end())
        return fmt::format("write {} {}", fault->flag, flag.value);
  }
  const std::string word = is_about_unknown(program, error) ? unknown_flag(program) : "";
  const std::vector<std::string> flags = flags_of(verb);
  const std::string meant = did_you_mean(word, std::vector<std::string_view>(flags.begin(), flags.end()));
  return fmt::format("{}{}'{} --help' {}", value_hint(error), meant.empty() ? verbs_with(word, program) : meant,
                     table.name, &verb == &program ? "lists the verbs" : "explains the verb");
}

}  // namespace vestige::help
