#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace vestige::help {

/// A flag, or a positional argument, as people read about it.
struct FlagTable {
  std::vector<std::string> names;  ///< "-o", "--output"; a positional has its one name: "TRACE"
  std::string value;               ///< what it takes: "auto|paper|cpu", "OUT.csv|-"; empty for a switch
  std::string range;               ///< "1 to 1000000", "above 0"; empty when anything goes
  std::string description;    ///< a line that begins with two blanks explains one value: "  swarm  points that …"
  std::string default_value;  ///< empty when it has none
  std::string needs;          ///< another flag, without which it is refused
  std::string group;
  bool positional = false;
  bool required = false;
  bool repeated = false;  ///< takes several values
};

/// A program or one of its verbs.
struct CommandTable {
  std::string name;  ///< as it is called: "vestige record"
  std::string verb;  ///< its last word
  std::string summary;
  std::string examples;  ///< lines, each indented by two blanks
  std::string footer;
  std::string group;
  std::vector<FlagTable> flags;  ///< positionals first
  std::vector<CommandTable> verbs;
};

/// Reads the tables that CLI11 parses by. Verbs and flags in the group "" are hidden, and left out.
CommandTable command_table(const CLI::App& app);

/// A word that a flag's value may be, and what it means, if that is said.
struct FixedValue {
  std::string word;
  std::string meaning;
};

/// The lower-case words of a flag's "auto|paper|FILE", and those that its description explains one a line.
std::vector<FixedValue> fixed_values(const FlagTable& flag);

/// Whether a flag's value may be the name of a file or a folder.
bool takes_path(const FlagTable& flag);

}  // namespace vestige::help
