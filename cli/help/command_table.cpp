#include "cli/help/command_table.hpp"

#include <algorithm>
#include <sstream>
#include <string_view>
#include <utility>

#include "cli/help/help_text.hpp"

namespace vestige::help {

namespace {

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  return parts;
}

/// CLI11 writes "TEXT:{a,b}", "UINT:INT in [1 - 10]" or "FLOAT:above 0": a type, and what a validator says of it. A
/// colon before a "|", as in "file:OUT|-", belongs to the type.
void describe_value(const std::string& type, FlagTable& flag) {
  const std::size_t last_bar = type.rfind('|');
  const std::size_t colon = type.find(':', last_bar == std::string::npos ? 0 : last_bar);
  flag.value = type.substr(0, colon);
  if (flag.value == "UINT" || flag.value == "INT") flag.value = "N";
  if (flag.value == "FLOAT") flag.value = "X";
  std::string constraint = colon == std::string::npos ? "" : type.substr(colon + 1);
  constexpr std::string_view kRange = "INT in [";
  if (constraint.starts_with('{')) {
    flag.value = constraint.substr(1, constraint.size() - 2);
    std::ranges::replace(flag.value, ',', '|');
  } else if (constraint.starts_with(kRange)) {
    constraint = constraint.substr(kRange.size(), constraint.size() - kRange.size() - 1);
    flag.range = constraint.replace(constraint.find(" - "), 3, " to ");
  } else {
    flag.range = constraint == "NONNEGATIVE" ? "at least 0" : constraint;
  }
}

FlagTable flag_table(const CLI::Option& option) {
  FlagTable flag;
  flag.positional = !option.nonpositional();
  if (flag.positional) {
    flag.names = {option.get_name(true)};
  } else {
    for (const std::string& name : option.get_snames()) flag.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) flag.names.push_back("--" + name);
  }
  if (option.get_items_expected_max() != 0) describe_value(option.get_type_name(), flag);
  flag.description = option.get_description();
  flag.default_value = option.get_default_str();
  // A default that is worked out at run time stands in the description.
  constexpr std::string_view kDefault = " [default: ";
  if (const std::size_t place = flag.description.find(kDefault); place != std::string::npos) {
    flag.default_value = flag.description.substr(place + kDefault.size());
    flag.default_value.pop_back();
    flag.description.resize(place);
  }
  for (const CLI::Option* needed : option.get_needs()) flag.needs = needed->get_name();
  flag.group = option.get_group();
  flag.required = option.get_required();
  flag.repeated = option.get_items_expected_max() > 1;
  return flag;
}

}  // namespace

CommandTable command_table(const CLI::App& app) {
  CommandTable table;
  table.verb = app.get_name();
  table.name = table.verb;
  for (const CLI::App* parent = app.get_parent(); parent != nullptr; parent = parent->get_parent())
    table.name = parent->get_name() + " " + table.name;
  table.summary = app.get_description();
  table.footer = app.get_footer();
  table.group = app.get_group();
  if (const auto* formatter = dynamic_cast<const HelpFormatter*>(app.get_formatter().get()))
    table.examples = formatter->examples();
  for (const bool positional : {true, false})
    for (const CLI::Option* option : app.get_options())
      if (option->nonpositional() != positional && !option->get_group().empty())
        table.flags.push_back(flag_table(*option));
  for (const CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; }))
    if (!verb->get_group().empty()) table.verbs.push_back(command_table(*verb));
  return table;
}

std::vector<FixedValue> fixed_values(const FlagTable& flag) {
  std::vector<FixedValue> values;
  for (const std::string& word : split(flag.value, '|'))
    if (word != "-" && word.find_first_not_of("abcdefghijklmnopqrstuvwxyz_-") == std::string::npos)
      values.push_back({word, ""});
  for (const std::string& line : split(flag.description, '\n')) {
    if (!line.starts_with("  ")) continue;
    const std::size_t end = std::min(line.find(' ', 2), line.size());
    const std::size_t meaning = std::min(line.find_first_not_of(' ', end), line.size());
    values.push_back({line.substr(2, end - 2), line.substr(meaning)});
  }
  return values;
}

std::vector<std::string> path_words(const FlagTable& flag) {
  std::vector<std::string> words =
      split(flag.positional && flag.value == "TEXT" ? flag.names.front() : flag.value, '|');
  std::erase_if(words, [](const std::string& full) {
    const std::string word = full.substr(full.find_last_of("=:") + 1);
    return !word.starts_with("FILE") && !word.starts_with("OUT") && word != "DIR" && word != "TRACE" &&
           word != "MCAP" && word != "JSON" && word != "CSV" && word != "EXR";
  });
  return words;
}

bool takes_path(const FlagTable& flag) {
  return std::ranges::any_of(path_words(flag),
                             [](const std::string& word) { return word.find_first_of("=:") == std::string::npos; });
}

}  // namespace vestige::help
