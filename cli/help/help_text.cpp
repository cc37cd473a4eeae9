#include "cli/help/help_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <vector>

#include "cli/help/command_table.hpp"

namespace vestige::help {

namespace {

constexpr std::size_t kColumns = 100;
constexpr std::size_t kNameColumns = 28;

/// Breaks a line at blanks; what follows is indented. `column` is where the line begins.
std::string wrap_line(const std::string& line, std::size_t column, std::size_t indent) {
  std::string wrapped;
  std::istringstream words(line);
  for (std::string word; words >> word;) {
    if (!wrapped.empty() && column + 1 + word.size() > kColumns) {
      wrapped += "\n" + std::string(indent, ' ');
      column = indent;
    } else if (!wrapped.empty()) {
      wrapped += ' ';
      ++column;
    }
    wrapped += word;
    column += word.size();
  }
  return wrapped;
}

/// Breaks every line of `text`. Lines that begin with two blanks, "  swarm  points that …", become a table.
std::string wrap(const std::string& text, std::size_t column, std::size_t indent) {
  std::string wrapped;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (!wrapped.empty()) {
      wrapped += "\n" + std::string(indent, ' ');
      column = indent;
    }
    const std::size_t word_end = line.starts_with("  ") ? line.find(' ', 2) : 0;
    const std::size_t hang = line.find_first_not_of(' ', word_end == std::string::npos ? 0 : word_end);
    if (word_end != 0 && hang != std::string::npos) {
      wrapped += line.substr(0, hang) + wrap_line(line.substr(hang), column + hang, indent + hang);
    } else {
      wrapped += wrap_line(line, column, indent);
    }
  }
  return wrapped;
}

std::string row(const std::string& name, const std::string& description) {
  const std::string start = fmt::format("  {:<{}}", name, kNameColumns - 2);
  const bool fits = name.size() + 3 <= kNameColumns;
  return start + (fits ? "" : "\n" + std::string(kNameColumns, ' ')) + wrap(description, kNameColumns, kNameColumns) +
         "\n";
}

template <typename Items>
std::vector<std::string> groups_in_order(const Items& items) {
  std::vector<std::string> groups;
  for (const auto& item : items)
    if (std::ranges::find(groups, item.group) == groups.end()) groups.push_back(item.group);
  std::stable_partition(groups.begin(), groups.end(), [](const std::string& group) { return group != kCommonGroup; });
  return groups;
}

}  // namespace

std::string spelling(const FlagTable& flag) {
  std::string text = fmt::format("{}", fmt::join(flag.names, ", "));
  if (flag.positional) return text + (flag.repeated ? "..." : "");
  return flag.value.empty() ? text : text + " " + flag.value;
}

std::string usage(const CommandTable& command) {
  std::string text = command.name + " [OPTIONS]";
  for (const FlagTable& flag : command.flags)
    if (flag.required && !flag.positional) text += fmt::format(" {} {}", flag.names.front(), flag.value);
  for (const FlagTable& flag : command.flags)
    if (flag.positional) text += flag.required ? " " + spelling(flag) : fmt::format(" [{}]", spelling(flag));
  return command.verbs.empty() ? text : text + " VERB ...";
}

std::string notes_of(const FlagTable& flag) {
  std::vector<std::string> notes;
  if (!flag.range.empty()) notes.push_back(flag.range);
  if (flag.required && !flag.positional) notes.emplace_back("required");
  if (!flag.needs.empty()) notes.push_back("with " + flag.needs);
  if (!flag.default_value.empty()) notes.push_back("default: " + flag.default_value);
  return fmt::format("{}", fmt::join(notes, "; "));
}

std::string full_description(const FlagTable& flag) {
  const std::string notes = notes_of(flag);
  return notes.empty() ? flag.description : fmt::format("{} [{}]", flag.description, notes);
}

std::vector<std::string> groups_of(const CommandTable& command) {
  std::vector<FlagTable> flags = command.flags;
  std::erase_if(flags, [](const FlagTable& flag) { return flag.positional; });
  return groups_in_order(flags);
}

std::vector<std::string> verb_groups_of(const CommandTable& command) {
  return groups_in_order(command.verbs);
}

std::string HelpFormatter::make_help(const CLI::App* app, std::string, CLI::AppFormatMode) const {
  const CommandTable command = command_table(*app);
  std::string text = fmt::format("Examples:\n{}\n{}\n\nUsage: {}\n", command.examples,
                                 wrap(command.summary + ".", 0, 0), wrap(usage(command), 7, 7));
  for (const std::string& group : verb_groups_of(command)) {
    text += fmt::format("\n{}:\n", group);
    for (const CommandTable& verb : command.verbs)
      if (verb.group == group) text += row(verb.verb, verb.summary);
  }
  const bool positionals = std::ranges::any_of(command.flags, [](const FlagTable& flag) { return flag.positional; });
  if (positionals) text += "\nArguments:\n";
  for (const FlagTable& flag : command.flags)
    if (flag.positional) text += row(spelling(flag), full_description(flag));
  for (const std::string& group : groups_of(command)) {
    text += fmt::format("\n{}:\n", group);
    for (const FlagTable& flag : command.flags)
      if (!flag.positional && flag.group == group) text += row(spelling(flag), full_description(flag));
  }
  if (!command.footer.empty()) text += fmt::format("\n{}\n", wrap(command.footer, 0, 0));
  return text;
}

}  // namespace vestige::help
