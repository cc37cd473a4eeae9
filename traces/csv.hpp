#pragma once

#include <charconv>
#include <cstddef>
#include <string>
#include <string_view>

#include "traces/error.hpp"

namespace vestige {

/// Goes through the rows of a CSV file of numbers with a fixed header. Lines may end in LF or CRLF; empty lines are
/// skipped, and a UTF-8 byte order mark in front of the header.
class CsvLines {
 public:
  /// `text` must stay. Throws `Error` at "NAME, line 1" when the first line is not `header`; `remedy` ends every error.
  CsvLines(std::string_view text, std::string name, std::string_view header, std::string_view remedy);

  /// Goes to the next row; false at the end of the file.
  bool next();

  /// Reads the next field of the row as a number; false when there is none left or it is not wholly a number.
  template <typename Number>
  bool take(Number& value) {
    if (at_end_) return false;
    const std::size_t comma = row_.find(',');
    const std::string_view field = row_.substr(0, comma);
    const auto [end, failure] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (failure != std::errc() || end != field.data() + field.size()) return false;
    at_end_ = comma == std::string_view::npos;
    if (!at_end_) row_.remove_prefix(comma + 1);
    return true;
  }

  /// Nothing is left of the row.
  bool at_end() const { return at_end_; }

  Error error(std::string_view cause) const { return error(cause, remedy_); }
  Error error(std::string_view cause, std::string_view remedy) const;

 private:
  bool next_line();

  std::string_view text_;
  std::string name_;
  std::string_view remedy_;
  std::string_view row_;
  std::size_t line_ = 0;
  bool at_end_ = true;
};

}  // namespace vestige
