#pragma once

#include <string>
#include <vector>

#include "analysis/claims/result.hpp"

namespace vestige {

/// Where a result comes from.
struct Origin {
  std::string command;
  std::string time;      ///< UTC, as in the file
  std::string machine;   ///< processor, cores
  std::string renderer;  ///< GL renderers that took part, software marked as such; "no GL" if none did
  std::string commit;    ///< ten digits, "+" if the tree was dirty
};

/// Throws `Error` if the result does not say where it comes from.
Origin origin_of(const Result& result);

/// A command, or several that differ in one name or number.
struct Command {
  std::string text;                ///< "vestige replay out/<hug|rain>.mcap": one run for hug, one for rain
  std::vector<std::string> files;  ///< one for each run, in the order of the alternatives
};

/// Returns the commands that made these results. Commands that differ only in one name or number stand together, if
/// they ran on the same machine and commit.
std::vector<Command> commands_of(const std::vector<Result>& run);

/// Where two words differ: between the parts that they share at their beginning and end.
struct Difference {
  std::size_t begin = 0;
  std::string of_first;
  std::string of_second;
};

/// Cuts beside characters that are no letters or digits. Both sides are empty if nothing is left of one of them.
Difference difference(const std::string& first, const std::string& second);

}  // namespace vestige
