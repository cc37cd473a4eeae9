#include "cli/help/manual.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <sstream>

#include "cli/help/help_text.hpp"

namespace vestige::help {

namespace {

/// Text as roff: what it would take for commands is escaped. A hyphen stays one that can be copied from the page.
std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == ' ' && result.ends_with('\n')) continue;
    if (c == '\n') {
      result += "\n.br\n";
    } else if (c == '\\') {
      result += "\\e";
    } else if (c == '-') {
      result += "\\-";
    } else if (c == '\'') {
      result += "\\(aq";
    } else if (c == '.' && (result.empty() || result.back() == '\n')) {
      result += "\\&.";
    } else {
      result += c;
    }
  }
  return result;
}

std::string bold(const std::string& text) {
  return "\\fB" + escaped(text) + "\\fR";
}

std::string tagged(const std::string& tag, const std::string& text) {
  return fmt::format(".TP\n{}\n{}\n", tag, escaped(text));
}

std::string flag_entry(const FlagTable& flag) {
  std::string tag;
  for (const std::string& name : flag.names) tag += (tag.empty() ? "" : ", ") + bold(name);
  if (!flag.positional && !flag.value.empty()) tag += " \\fI" + escaped(flag.value) + "\\fR";
  return tagged(tag, full_description(flag));
}

/// Examples are lines indented by two blanks.
std::string examples(const CommandTable& command) {
  std::string text;
  std::istringstream lines(command.examples);
  for (std::string line; std::getline(lines, line);)
    text += fmt::format("{}\n", escaped(line.substr(std::min<std::size_t>(2, line.size()))));
  return ".nf\n" + text + ".fi\n";
}

std::string upper_case(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

std::string flags_of(const CommandTable& command) {
  std::string text;
  for (const FlagTable& flag : command.flags)
    if (flag.positional) text += flag_entry(flag);
  if (!text.empty()) text = ".SH ARGUMENTS\n" + text;
  for (const std::string& group : groups_of(command)) {
    text += fmt::format(".SH {}\n", escaped(upper_case(group)));
    for (const FlagTable& flag : command.flags)
      if (!flag.positional && flag.group == group) text += flag_entry(flag);
  }
  return text;
}

std::string verb_list(const CommandTable& command, VerbPages verb_pages) {
  std::string text;
  for (const CommandTable& verb : command.verbs) {
    if (verb_pages == VerbPages::kOwn) {
      text += tagged(bold(verb.verb), verb.summary + ".");
    } else {
      text += fmt::format(".SS {}\n{}.\n.PP\n{}\n.PP\n{}", escaped(verb.name), escaped(verb.summary), bold(usage(verb)),
                          examples(verb));
      for (const FlagTable& flag : verb.flags) text += flag_entry(flag);
    }
  }
  return text.empty() ? "" : ".SH VERBS\n" + text;
}

std::string see_also(const CommandTable& command, VerbPages verb_pages) {
  if (verb_pages == VerbPages::kNone || command.verbs.empty()) return ".BR vestige (1)\n";
  std::string text;
  for (const CommandTable& verb : command.verbs)
    text += fmt::format("{}.BR {} (1)", text.empty() ? "" : ",\n", escaped(page_name(verb)));
  return text + "\n";
}

}  // namespace

std::string page_name(const CommandTable& command) {
  std::string name = command.name;
  std::ranges::replace(name, ' ', '-');
  return name;
}

std::string manual_page(const CommandTable& command, VerbPages verb_pages, const std::string& version,
                        const std::string& date) {
  std::string text = fmt::format(".TH {} 1 \"{}\" \"vestige {}\" \"User Commands\"\n",
                                 escaped(upper_case(page_name(command))), date, version);
  text += fmt::format(".SH NAME\n{} \\- {}\n", escaped(page_name(command)), escaped(command.summary));
  text += fmt::format(".SH SYNOPSIS\n{}\n", bold(usage(command)));
  text += fmt::format(".SH EXAMPLES\n{}", examples(command));
  text += verb_list(command, verb_pages);
  text += flags_of(command);
  text += ".SH EXIT STATUS\n";
  for (const auto& [code, meaning] : kExitCodes) text += tagged(bold(std::to_string(code)), meaning);
  text += ".SH ENVIRONMENT\n";
  for (const auto& [variable, meaning] : kEnvironment) text += tagged(bold(variable), meaning);
  return text + fmt::format(".SH SEE ALSO\n{}", see_also(command, verb_pages));
}

}  // namespace vestige::help
