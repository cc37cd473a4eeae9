#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <utility>

namespace vestige::help {

/// The help group of the flags that almost every verb has. It comes last.
inline constexpr const char* kCommonGroup = "Common flags";

/// Formats the text of --help: two examples that run as they are, then usage, arguments and flags with every default,
/// in 100 columns.
class HelpFormatter : public CLI::FormatterBase {
 public:
  explicit HelpFormatter(std::string examples) : examples_(std::move(examples)) {}
  const std::string& examples() const { return examples_; }
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override;

 private:
  std::string examples_;
};

struct FlagTable;
struct CommandTable;

/// "-o, --output OUT.csv|-"
std::string spelling(const FlagTable& flag);

/// "vestige sweep [OPTIONS] -o DIR [TRACE]": names every required flag and all positional arguments.
std::string usage(const CommandTable& command);

/// Returns range, default and needed flag: "1 to 9; default: 3".
std::string notes_of(const FlagTable& flag);

/// Returns the description, followed by range, default and needed flag in brackets.
std::string full_description(const FlagTable& flag);

/// Returns the groups of the flags in the order of their first flag, with the common group last.
std::vector<std::string> groups_of(const CommandTable& command);

/// As above, for the groups of verbs.
std::vector<std::string> verb_groups_of(const CommandTable& command);

}  // namespace vestige::help
