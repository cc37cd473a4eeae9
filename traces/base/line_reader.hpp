#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "traces/base/descriptor.hpp"

namespace vestige {

/// Reads a text file line by line; holds one line and one block at a time. "-" is standard input. Throws `Error` with
/// the name of the file if it does not exist, cannot be read, is a folder, or has a line longer than 64 MiB.
class LineReader {
 public:
  explicit LineReader(const std::filesystem::path& path) : input_(path) {}

  /// Reads the next line without its end (LF or CRLF), valid until the next call. Returns false at the end of the file.
  bool next(std::string_view& line);

  /// The name that error messages use.
  const std::string& name() const { return input_.name(); }
  /// Number of the last line read, from 1.
  std::size_t line() const { return line_; }
  /// Fraction of the file read so far, 0 … 1; always 0 if the file has no size.
  double share() const;

 private:
  bool fill();

  InputDescriptor input_;
  std::string buffer_;
  std::size_t begin_ = 0;  ///< start of the unread part of `buffer_`
  std::size_t line_ = 0;
  std::size_t bytes_read_ = 0;
};

}  // namespace vestige
