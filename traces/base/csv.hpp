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

/// Reads the rows of a CSV file, with or without a fixed header. Lines may end in LF or CRLF. Skips empty lines and a
/// UTF-8 byte order mark in front of the header.
class CsvLines {
 public:
  /// Keeps a reference to `text`. Throws `Error` at "NAME, line 1" if the first line is not `header`. Every error ends
  /// with `remedy`.
  CsvLines(std::string_view text, std::string name, std::string_view header, std::string_view remedy);

  /// For a file without a header. Keeps a reference to `text`.
  CsvLines(std::string_view text, std::string name, std::string_view remedy);

  /// For a file that is read line by line and may have any header. Call `take_header` first. Keeps a reference to
  /// `reader`.
  CsvLines(LineReader& reader, std::string_view remedy);

  /// Returns the fields of the first line, and unquotes quoted fields (RFC 4180, but within one line). Throws `Error`
  /// if there is no first line or a quote is not closed.
  std::vector<std::string> take_header();

  /// Whether the first line of `text` is `header`.
  static bool has_header(std::string_view text, std::string_view header);

  /// Sets the remedy of later errors, for callers that learn more from the header.
  void set_remedy(std::string_view remedy) { remedy_ = remedy; }

  /// Goes to the next row. Returns false at the end of the file.
  bool next();

  /// Reads the next field of the row without unquoting it. Returns false if no field is left.
  bool take_text(std::string_view& field);

  /// Reads the next field of the row as a number. Returns false if no field is left or the field is not entirely a
  /// number.
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

  /// Whether all fields of the row were read.
  bool at_end() const { return at_end_; }

  /// Line number of the row, from 1.
  std::size_t line() const { return line_; }

  Error error(std::string_view cause) const { return error(cause, remedy_); }
  Error error(std::string_view cause, std::string_view remedy) const;

 private:
  bool next_line();

  /// Rounds a number that is too small for its type. Returns false if it is too large instead.
  template <typename Number>
  static bool round_to_zero(std::string_view field, Number& value) {
    const double number = std::strtod(std::string(field).c_str(), nullptr);
    value = static_cast<Number>(number);
    return std::abs(number) < 1;
  }

  std::string_view text_;
  LineReader* reader_ = nullptr;  ///< used instead of `text_` if not null
  std::string name_;
  std::string_view remedy_;
  std::string_view row_;
  std::size_t line_ = 0;
  bool at_end_ = true;
};

/// Formats a field for CSV. Quotes it if it holds a comma or a quote, or begins or ends with a space. Replaces line
/// ends by spaces.
std::string csv_field(std::string_view text);

}  // namespace vestige
