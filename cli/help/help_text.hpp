#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <utility>

namespace vestige::help {

/// The group of the flags that every verb has; it comes last.
inline constexpr const char* kCommonGroup = "Common to all verbs";

/// What stands behind --help: two examples that run as they are, then usage, arguments and flags with every default,
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

/// "vestige sweep [OPTIONS] -o DIR [TRACE]": whatever cannot be left out stands there.
std::string usage(const CommandTable& command);

/// The description with range, default and needed flag behind it, in brackets.
std::string full_description(const FlagTable& flag);

/// Groups in the order of their first flag, the common one last.
std::vector<std::string> groups_of(const CommandTable& command);

/// The same for the groups of verbs.
std::vector<std::string> verb_groups_of(const CommandTable& command);

}  // namespace vestige::help
