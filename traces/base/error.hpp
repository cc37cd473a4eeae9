#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace vestige {

/// A failure that the user can act on. `what()` reads "WHERE: CAUSE\n  REMEDY". The command line prints it and exits
/// with 1. WHERE is a file (with a byte offset or field where that is known) or a flag.
class Error : public std::runtime_error {
 public:
  Error(std::string_view where, std::string_view cause, std::string_view remedy);
  std::string_view fault() const;   ///< "WHERE: CAUSE"
  std::string_view remedy() const;  ///< may be empty
};

/// The command was called wrongly: the same form of message, exit code 2.
class UsageError : public Error {
 public:
  using Error::Error;
};

/// Whoever read the pipe that was written to has stopped.
class ReaderGone : public Error {
 public:
  using Error::Error;
};

/// Names out of files may hold what moves a terminal's cursor: control characters as \xHH, but for line ends.
std::string printable(std::string_view text);

/// Writes to standard error. Where that is closed, nobody is told, and nothing fails for it.
void print_message(const std::string& text);

}  // namespace vestige
