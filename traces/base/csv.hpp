#pragma once

#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "traces/base/error.hpp"
#include "traces/base/line_reader.hpp"

namespace vestige {

/// Goes through the rows of a CSV file, with a fixed header or none. Lines may end in LF or CRLF; empty lines are
/// skipped, and a UTF-8 byte order mark in front of the header.
class CsvLines {
 public:
  /// `text` must stay. Throws `Error` at "NAME, line 1" when the first line is not `header`; `remedy` ends every error.
  CsvLines(std::string_view text, std::string name, std::string_view header, std::string_view remedy);

  /// Without a header.
  CsvLines(std::string_view text, std::string name, std::string_view remedy);

  /// Of a file that is read line by line, with any header: `take_header` is to be called first. `reader` must stay.
  CsvLines(LineReader& reader, std::string_view remedy);

  /// The first line's fields, unquoted where they are quoted (RFC 4180, though on one line). Throws `Error` where there
  /// is none.
  std::vector<std::string> take_header();

  /// Whether the first line of `text` is `header`.
  static bool has_header(std::string_view text, std::string_view header);

  /// What ends every error from here on, where the header tells more.
  void set_remedy(std::string_view remedy) { remedy_ = remedy; }

  /// Goes to the next row; false at the end of the file.
  bool next();

  /// Reads the next field of the row as it is; false when there is none left.
  bool take_text(std::string_view& field);

  /// Reads the next field of the row as a number; false when there is none left or it is not wholly a number.
  template <typename Number>
  bool take(Number& value) {
    std::string_view field;
    if (!take_text(field)) return false;
    const auto [end, failure] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (end != field.data() + field.size()) return false;
    if constexpr (std::is_floating_point_v<Number>)
      if (failure == std::errc::result_out_of_range) return round_to_zero(field, value);
    return failure == std::errc();
  }

  /// Nothing is left of the row.
  bool at_end() const { return at_end_; }

  /// Of the row, from 1.
  std::size_t line() const { return line_; }

  Error error(std::string_view cause) const { return error(cause, remedy_); }
  Error error(std::string_view cause, std::string_view remedy) const;

 private:
  bool next_line();

  /// A number that is out of range since it is so small; false for one that is too large.
  template <typename Number>
  static bool round_to_zero(std::string_view field, Number& value) {
    const double number = std::strtod(std::string(field).c_str(), nullptr);
    value = static_cast<Number>(number);
    return std::abs(number) < 1;
  }

  std::string_view text_;
  LineReader* reader_ = nullptr;  ///< in place of `text_`
  std::string name_;
  std::string_view remedy_;
  std::string_view row_;
  std::size_t line_ = 0;
  bool at_end_ = true;
};

/// A field as CSV has it: in quotes where it holds a comma, a quote or white space at its ends. Line ends become
/// spaces.
std::string csv_field(std::string_view text);

}  // namespace vestige
