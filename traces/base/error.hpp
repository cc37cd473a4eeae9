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

/// The command line is wrong. The message has the same form; the exit code is 2.
class UsageError : public Error {
 public:
  using Error::Error;
};

/// The reader of the pipe that was written to has closed it.
class PipeClosed : public Error {
 public:
  using Error::Error;
};

/// Returns `text` with control characters, except line feeds, replaced by \xHH. Names from files may contain characters
/// that move a terminal's cursor.
std::string printable(std::string_view text);

/// Writes to standard error. If standard error is closed, the message is lost without an error.
void print_message(const std::string& text);

}  // namespace vestige
