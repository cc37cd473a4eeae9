#include "analysis/stress/query_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <charconv>
#include <cmath>

#include "traces/base/csv.hpp"
#include "traces/files/input_file.hpp"

namespace vestige {

namespace {

using boost::multiprecision::cpp_int;
using boost::multiprecision::cpp_rational;

constexpr std::string_view kHeader = "source,query,gt,float_exact,px,py,pz,qx,qy,qz,ax,ay,az,bx,by,bz,cx,cy,cz";
constexpr std::string_view kFractionRemedy =
    "each row is x, y, z as numerator,denominator, then the truth 0 or 1; each query has eight rows: the point and the "
    "triangle's three corners at t = 0, then at t = 1";
constexpr std::string_view kHexadecimalRemedy =
    "each row is a name, a number, the truth 0 or 1, 0 or 1, and x, y, z of p, q, a, b, c as hexadecimal doubles: "
    "0x1.8p+1";
constexpr std::string_view kNotSeven = "is not seven whole numbers";
constexpr std::size_t kRowsPerQuery = 8;
constexpr std::size_t kMostDigits = 2000;  ///< the least double has 324 digits after its "1/"

/// "-12" or "+12".
cpp_int take_whole(CsvLines& lines) {
  std::string_view field;
  if (!lines.take_text(field)) throw lines.error(kNotSeven);
  const std::string_view whole = field;
  const bool negative = field.starts_with('-');
  if (negative || field.starts_with('+')) field.remove_prefix(1);
  if (field.empty() || field.find_first_not_of("0123456789") != std::string_view::npos)
    throw lines.error(fmt::format("'{}' is not a whole number", whole));
  if (field.size() > kMostDigits)
    throw lines.error(fmt::format("a number has {} digits, more than {}", field.size(), kMostDigits));
  // A leading zero would make it octal.
  field.remove_prefix(std::min(field.find_first_not_of('0'), field.size() - 1));
  cpp_int value(field);
  if (negative) value = -value;
  return value;
}

double take_fraction(CsvLines& lines, int axis, Inexact inexact) {
  const cpp_int numerator = take_whole(lines);
  const cpp_int denominator = take_whole(lines);
  if (denominator.is_zero()) throw lines.error(fmt::format("the denominator of {} is 0", "xyz"[axis]));
  const cpp_rational exact(denominator > 0 ? numerator : cpp_int(-numerator), abs(denominator));
  const auto value = exact.convert_to<double>();
  if (!std::isfinite(value)) throw lines.error("a coordinate is beyond the largest double");
  if (inexact == Inexact::kRefuse && cpp_rational(value) != exact)
    throw lines.error("a coordinate lies between two doubles, so the truth may be wrong for both",
                      "add --round-fp32: it rounds the coordinates and computes the truth again");
  return value;
}

bool take_truth(CsvLines& lines) {
  int truth = 0;
  if (!lines.take(truth) || (truth != 0 && truth != 1)) throw lines.error("the truth is neither 0 nor 1");
  return truth == 1;
}

/// "-0x1.8p+1".
double take_hexadecimal(CsvLines& lines) {
  std::string_view field;
  if (!lines.take_text(field)) throw lines.error("is not 19 fields");
  std::string_view digits = field;
  const bool negative = digits.starts_with('-');
  if (negative) digits.remove_prefix(1);
  double value = 0;
  const bool prefixed = digits.starts_with("0x") || digits.starts_with("0X");
  if (prefixed) digits.remove_prefix(2);
  const auto [end, failure] =
      std::from_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::hex);
  if (!prefixed || failure != std::errc() || end != digits.data() + digits.size() || digits.starts_with('-') ||
      !std::isfinite(value))
    throw lines.error(fmt::format("'{}' is not a finite hexadecimal double", field));
  return negative ? -value : value;
}

void read_fractions(CsvLines& lines, Inexact inexact, std::vector<Query>& queries) {
  std::array<glm::dvec3, kRowsPerQuery> point = {};
  std::size_t rows = 0;
  Query query;
  while (lines.next()) {
    for (int axis = 0; axis < 3; ++axis) point[rows][axis] = take_fraction(lines, axis, inexact);
    const bool truth = take_truth(lines);
    if (!lines.at_end()) throw lines.error(kNotSeven);
    if (rows == 0) {
      query.line = lines.line();
      query.truth = truth;
    } else if (truth != query.truth) {
      throw lines.error(fmt::format("the query that begins in line {} has two truths", query.line));
    }
    if (++rows < kRowsPerQuery) continue;
    query.way = {point[0], point[4]};
    query.before = {point[1], point[2], point[3]};
    query.after = {point[5], point[6], point[7]};
    queries.push_back(query);
    rows = 0;
  }
  if (rows != 0) throw lines.error(fmt::format("the file ends in the middle of a query, after {} of 8 rows", rows));
}

void read_hexadecimals(CsvLines& lines, std::vector<Query>& queries) {
  while (lines.next()) {
    Query query;
    query.line = lines.line();
    std::string_view source;
    std::string_view number;
    lines.take_text(source);
    lines.take_text(number);
    query.truth = take_truth(lines);
    std::string_view float_exact;
    lines.take_text(float_exact);
    for (glm::dvec3* point : {&query.way.start, &query.way.end, &query.after.a, &query.after.b, &query.after.c})
      for (int axis = 0; axis < 3; ++axis) (*point)[axis] = take_hexadecimal(lines);
    if (!lines.at_end()) throw lines.error("is not 19 fields");
    query.before = query.after;
    queries.push_back(query);
  }
}

}  // namespace

QueryFile parse_queries(std::string_view text, const std::string& name, Inexact inexact) {
  QueryFile file;
  file.name = name;
  file.ends_in_newline = text.empty() || text.back() == '\n';
  if (CsvLines::has_header(text, kHeader)) {
    file.kind = QueryKind::kSegmentTriangle;
    CsvLines lines(text, name, kHeader, kHexadecimalRemedy);
    read_hexadecimals(lines, file.queries);
  } else {
    CsvLines lines(text, name, kFractionRemedy);
    read_fractions(lines, inexact, file.queries);
  }
  if (file.queries.empty()) throw Error(name, "holds no query", kFractionRemedy);
  return file;
}

QueryFile read_query_file(const std::filesystem::path& path, Inexact inexact) {
  return parse_queries(read_text_file(path), path.string(), inexact);
}

}  // namespace vestige
