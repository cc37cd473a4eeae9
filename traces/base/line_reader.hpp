#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "traces/base/descriptor.hpp"

namespace vestige {

/// Reads a text file line by line, holding one line and a block at a time. "-" is standard input. Throws `Error` naming
/// the file: missing, unreadable, a folder, a line longer than 64 MiB.
class LineReader {
 public:
  explicit LineReader(const std::filesystem::path& path) : input_(path) {}

  /// The next line without its end (LF or CRLF), valid until the next call; false at the end of the file.
  bool next(std::string_view& line);

  /// What errors are to name.
  const std::string& name() const { return input_.name(); }
  /// Of the last line, from 1.
  std::size_t line() const { return line_; }
  /// Share of the file read, 0 … 1; 0 where it has no size.
  double share() const;

 private:
  bool fill();

  InputDescriptor input_;
  std::string buffer_;
  std::size_t begin_ = 0;  ///< in `buffer_`, of what was not given out yet
  std::size_t line_ = 0;
  std::size_t bytes_read_ = 0;
};

}  // namespace vestige
