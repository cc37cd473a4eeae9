#include "traces/base/csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace vestige {

CsvLines::CsvLines(std::string_view text, std::string name, std::string_view remedy)
    : text_(text), name_(std::move(name)), remedy_(remedy) {
  if (text_.starts_with("\xEF\xBB\xBF")) text_.remove_prefix(3);
}

CsvLines::CsvLines(std::string_view text, std::string name, std::string_view header, std::string_view remedy)
    : CsvLines(text, std::move(name), remedy) {
  if (!next_line() || row_ != header) {
    line_ = 1;
    throw error(fmt::format("the header is not '{}'", header));
  }
}

CsvLines::CsvLines(LineReader& reader, std::string_view remedy)
    : reader_(&reader), name_(reader.name()), remedy_(remedy) {}

std::vector<std::string> CsvLines::take_header() {
  if (!next_line()) throw Error(name_, "is empty", remedy_);
  if (row_.starts_with("\xEF\xBB\xBF")) row_.remove_prefix(3);
  std::vector<std::string> fields(1);
  for (std::size_t i = 0; i < row_.size();) {
    const bool quoted = row_[i] == '"' && fields.back().empty();
    if (quoted) {
      for (++i; i < row_.size() && (row_[i] != '"' || row_.substr(i).starts_with("\"\"")); ++i) {
        fields.back() += row_[i];
        if (row_[i] == '"') ++i;
      }
      if (i++ == row_.size()) throw error("a quote is not closed");
    }
    for (; i < row_.size() && row_[i] != ','; ++i) fields.back() += row_[i];
    if (i == row_.size()) break;
    fields.emplace_back();
    ++i;
  }
  return fields;
}

bool CsvLines::has_header(std::string_view text, std::string_view header) {
  CsvLines lines(text, "", "");
  return lines.next_line() && lines.row_ == header;
}

bool CsvLines::take_text(std::string_view& field) {
  if (at_end_) return false;
  const std::size_t comma = row_.find(',');
  field = row_.substr(0, comma);
  at_end_ = comma == std::string_view::npos;
  if (!at_end_) row_.remove_prefix(comma + 1);
  return true;
}

bool CsvLines::next_line() {
  at_end_ = false;
  if (reader_ != nullptr) {
    const bool more = reader_->next(row_);
    line_ = reader_->line();
    return more;
  }
  if (text_.empty()) return false;
  ++line_;
  const std::size_t end = std::min(text_.find('\n'), text_.size());
  row_ = text_.substr(0, end);
  text_.remove_prefix(std::min(end + 1, text_.size()));
  if (row_.ends_with('\r')) row_.remove_suffix(1);
  return true;
}

bool CsvLines::next() {
  while (next_line())
    if (!row_.empty()) return true;
  return false;
}

Error CsvLines::error(std::string_view cause, std::string_view remedy) const {
  return Error(fmt::format("{}, line {}", name_, line_), cause, remedy);
}

std::string csv_field(std::string_view text) {
  std::string field(text);
  for (char& one : field)
    if (one == '\n' || one == '\r') one = ' ';
  if (field.find_first_of(",\"") == std::string::npos && !field.starts_with(' ') && !field.ends_with(' ')) return field;
  std::string quoted(1, '"');
  for (const char one : field) quoted.append(one == '"' ? 2 : 1, one);
  quoted += '"';
  return quoted;
}

}  // namespace vestige
