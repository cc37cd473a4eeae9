#include "cli/help/markdown.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <sstream>
#include <string_view>
#include <vector>

#include "cli/help/help_text.hpp"
#include "cli/help/manual.hpp"

namespace vestige::help {

namespace {

constexpr std::size_t kPageColumns = 120;
constexpr const char* kIndexName = "README.md";
constexpr const char* kWrittenBy = "<!-- The program writes this page (man --markdown): do not edit it. -->\n\n";

bool is_word_letter(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0;
}

/// Text as Markdown: what it would take for markup is escaped. "_" between letters is none.
std::string as_markdown(const std::string& text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool within_word = i > 0 && i + 1 < text.size() && is_word_letter(text[i - 1]) && is_word_letter(text[i + 1]);
    if (std::string_view("\\`*<>~|").find(text[i]) != std::string_view::npos || (text[i] == '_' && !within_word))
      result += '\\';
    result += text[i];
  }
  return result;
}

std::string code(const std::string& text) {
  return "`" + text + "`";
}

/// Code in a table, whose cells "|" would end.
std::string code_in_cell(std::string text) {
  for (std::size_t i = 0; (i = text.find('|', i)) != std::string::npos; i += 2) text.insert(i, "\\");
  return code(text);
}

std::string code_block(const char* language, const std::string& text) {
  return fmt::format("```{}\n{}```\n\n", language, text);
}

/// "-", "#" or "1." at the beginning of a line would make it a list or a heading.
bool must_not_begin_line(const std::string& word) {
  return word.find_first_not_of("#+-=.)0123456789") == std::string::npos;
}

/// Breaks `text` at blanks. The first line is indented by `first` blanks, the others by `indent`.
std::string wrapped(const std::string& text, std::size_t first, std::size_t indent) {
  std::string line(first, ' ');
  std::string lines;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const bool is_first = line.find_first_not_of(' ') == std::string::npos;
    if (!is_first && line.size() + 1 + word.size() > kPageColumns && !must_not_begin_line(word)) {
      lines += line + "\n";
      line = std::string(indent, ' ') + word;
    } else {
      line += (is_first ? "" : " ") + word;
    }
  }
  return lines + line + "\n";
}

/// A description, below its flag. The values that it explains, each on a line that begins with two blanks, are a list.
std::string meaning_of(const FlagTable& flag) {
  std::string text;
  std::istringstream lines(flag.description);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("  ")) {
      text += (text.empty() ? "" : "\n") + wrapped(as_markdown(line), 2, 2);
      continue;
    }
    const std::size_t end = std::min(line.find(' ', 2), line.size());
    const std::size_t begin = std::min(line.find_first_not_of(' ', end), line.size());
    const std::string explained = begin == line.size() ? "" : ": " + as_markdown(line.substr(begin));
    text += wrapped("- " + code(line.substr(2, end - 2)) + explained, 2, 4);
  }
  return text;
}

std::string flag_item(const FlagTable& flag) {
  const std::string notes = notes_of(flag);
  return wrapped("- " + code(spelling(flag)) + (notes.empty() ? "" : fmt::format(" ({})", as_markdown(notes))) + "\\",
                 0, 2) +
         meaning_of(flag) + "\n";
}

std::string heading(std::size_t level, const std::string& text) {
  return fmt::format("{} {}\n\n", std::string(level, '#'), text);
}

std::string flag_lists(const CommandTable& command, std::size_t level) {
  std::string text;
  for (const FlagTable& flag : command.flags)
    if (flag.positional) text += flag_item(flag);
  if (!text.empty()) text = heading(level, "Arguments") + text;
  std::string shared;
  for (const std::string& group : groups_of(command)) {
    if (group != kCommonGroup) text += heading(level, group);
    for (const FlagTable& flag : command.flags) {
      if (flag.positional || flag.group != group) continue;
      if (group == kCommonGroup)
        shared += (shared.empty() ? "" : ", ") + code(flag.names.back());
      else
        text += flag_item(flag);
    }
  }
  if (shared.empty()) return text;
  return text + wrapped(fmt::format("[Common flags]({}#common-flags): {}.", kIndexName, shared), 0, 0) + "\n";
}

std::string usage_and_examples(const CommandTable& command) {
  std::string examples;
  std::istringstream lines(command.examples);
  for (std::string line; std::getline(lines, line);)
    examples += line.substr(std::min<std::size_t>(2, line.size())) + "\n";
  return wrapped(as_markdown(command.summary) + ".", 0, 0) + "\n" + code_block("", usage(command) + "\n") +
         (examples.empty() ? "" : "Examples:\n\n" + code_block("sh", examples));
}

/// `link` leads from a verb's name to its place.
template <typename Link>
std::string verb_table(const CommandTable& command, std::size_t level, const Link& link) {
  std::string text;
  for (const std::string& group : verb_groups_of(command)) {
    text += heading(level, group) + "| verb | does |\n|---|---|\n";
    for (const CommandTable& verb : command.verbs)
      if (verb.group == group)
        text += fmt::format("| [{}]({}) | {} |\n", verb.verb, link(verb), as_markdown(verb.summary));
    text += "\n";
  }
  return text;
}

/// An option's OUT is written, and so is its folder.
bool is_written(const FlagTable& flag, const std::vector<std::string>& paths) {
  return !flag.positional && std::ranges::any_of(paths, [](const std::string& word) {
    return word.starts_with("OUT") || word == "file:OUT" || word == "DIR";
  });
}

/// A row of a verb that names files, and of each of its verbs. A verb without flags is another program's.
std::string file_rows(const CommandTable& command, const std::string& place) {
  std::string read;
  std::string written;
  for (const FlagTable& flag : command.flags) {
    const std::vector<std::string> paths = path_words(flag);
    if (paths.empty() || flag.group == kCommonGroup) continue;
    std::string& cell = is_written(flag, paths) ? written : read;
    const std::string name =
        flag.positional ? spelling(flag) : fmt::format("{} {}", flag.names.back(), fmt::join(paths, "|"));
    cell += (cell.empty() ? "" : ", ") + code_in_cell(name);
  }
  const std::string name = command.name.substr(command.name.find(' ') + 1);
  if (command.flags.empty()) read = written = "see its page";
  std::string rows;
  if (!read.empty() || !written.empty()) rows = fmt::format("| [{}]({}) | {} | {} |\n", name, place, read, written);
  for (const CommandTable& verb : command.verbs) rows += file_rows(verb, fmt::format("{}#{}", place, page_name(verb)));
  return rows;
}

/// The first verb that has the common flags stands for all.
std::string common_flags(const CommandTable& program) {
  std::string text;
  for (const CommandTable& verb : program.verbs) {
    for (const FlagTable& flag : verb.flags)
      if (flag.group == kCommonGroup) text += flag_item(flag);
    if (!text.empty()) break;
  }
  return text;
}

}  // namespace

std::string markdown_page(const CommandTable& verb) {
  std::string text = kWrittenBy + heading(1, verb.name) + usage_and_examples(verb);
  text += verb_table(verb, 2, [](const CommandTable& own) { return "#" + page_name(own); });
  text += flag_lists(verb, 2);
  for (const CommandTable& own : verb.verbs)
    text += heading(2, own.name) + usage_and_examples(own) + flag_lists(own, 3);
  text.pop_back();
  return text;
}

std::string markdown_index(const CommandTable& program) {
  std::string text = kWrittenBy + heading(1, "Reference of " + program.name) + usage_and_examples(program);
  text += verb_table(program, 2, [](const CommandTable& verb) { return markdown_name(verb); });
  text += flag_lists(program, 2);
  text +=
      heading(2, kCommonGroup) + "The page of a verb names the common flags that it takes.\n\n" + common_flags(program);
  text += heading(2, "Exit codes") + "| code | means |\n|---|---|\n";
  for (const auto& [exit_code, meaning] : kExitCodes)
    text += fmt::format("| {} | {} |\n", exit_code, as_markdown(meaning));
  text += "\n" + heading(2, "Files") + "| verb | reads | writes |\n|---|---|---|\n";
  for (const CommandTable& verb : program.verbs) text += file_rows(verb, markdown_name(verb));
  text += "\n" + heading(2, "Environment") + "| variable | does |\n|---|---|\n";
  for (const auto& [variable, meaning] : kEnvironment)
    text += fmt::format("| {} | {} |\n", code(variable), as_markdown(meaning));
  return text;
}

std::string markdown_name(const CommandTable& verb) {
  return verb.name.substr(verb.name.rfind(' ') + 1) + ".md";
}

}  // namespace vestige::help
