#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace vestige::help {

/// A flag, or a positional argument, as documented for people.
struct FlagTable {
  std::vector<std::string> names;  ///< "-o", "--output"; a positional argument has one name: "TRACE"
  std::string value;               ///< its value: "auto|paper|cpu", "OUT.csv|-"; empty for a switch
  std::string range;               ///< "1 to 1000000", "above 0"; empty if any value is allowed
  std::string description;    ///< a line that begins with two blanks explains one value: "  swarm  points that …"
  std::string default_value;  ///< empty if there is no default
  std::string needs;          ///< another flag that must be given too
  std::string group;
  bool positional = false;
  bool required = false;
  bool repeated = false;  ///< takes several values
};

/// A program or one of its verbs.
struct CommandTable {
  std::string name;  ///< as the user calls it: "vestige record", "vestige map make"
  std::string verb;  ///< its last word
  std::string summary;
  std::string examples;  ///< lines, each indented by two blanks
  std::string footer;
  std::string group;
  std::vector<FlagTable> flags;  ///< positionals first
  std::vector<CommandTable> verbs;
};

/// Returns the tables that CLI11 parses by. Verbs and flags in the group "" are hidden, so they are left out.
CommandTable command_table(const CLI::App& app);

/// A word that is a possible value of a flag, and its meaning, if documented.
struct FixedValue {
  std::string word;
  std::string meaning;
};

/// Returns the lower-case words of a flag's "auto|paper|FILE", and the words that its description explains, one on each
/// line.
std::vector<FixedValue> fixed_values(const FlagTable& flag);

/// Returns the words of a flag's "builtin|FILE.png|TIME=FILE.png" that stand for, or hold, the name of a file or
/// folder.
std::vector<std::string> path_words(const FlagTable& flag);

/// Returns whether a flag's value may be the name of a file or a folder.
bool takes_path(const FlagTable& flag);

}  // namespace vestige::help
