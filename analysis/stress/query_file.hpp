#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "detector/decision.hpp"

namespace vestige {

/// Does the moving point meet the triangle, moving or not?
struct Query {
  Way way;
  Corners before;
  Corners after;
  bool truth = false;    ///< what the file says
  std::size_t line = 0;  ///< where the file has it
};

/// kPointTriangle: the triangle moves, so the file's truth is that of `ccd`. kSegmentTriangle: it is at rest.
enum class QueryKind { kPointTriangle, kSegmentTriangle };

struct QueryFile {
  std::string name;
  QueryKind kind = QueryKind::kPointTriangle;
  std::vector<Query> queries;
  bool ends_in_newline = true;  ///< false: its last number may have been cut
};

/// What to do with coordinates that no double equals: the file's truth is not about what a detector would then see.
enum class Inexact { kRefuse, kRound };

/// Reads one of two formats.
///
/// Without a header, eight rows a query: the point and the triangle's three corners at t = 0, then at t = 1. Each row
/// is seven whole numbers: x, y, z as numerator and denominator, and the truth, 0 or 1 (the format of the public sets
/// of Wang et al. 2021, A Large Scale Benchmark and an Inclusion-Based Algorithm for Continuous Collision Detection).
///
/// With the header "source,query,gt,float_exact,px,...,cz", a row a query: a segment from p to q, a triangle a, b, c,
/// in hexadecimal doubles, and the truth in `gt`.
///
/// Throws `Error` naming file and line: a malformed row, a denominator of zero, a number that is not finite or, with
/// kRefuse, no double, a query cut off or with two truths, no query at all.
QueryFile read_query_file(const std::filesystem::path& path, Inexact inexact);

/// `read_query_file` of `text`; `name` stands in errors.
QueryFile parse_queries(std::string_view text, const std::string& name, Inexact inexact);

}  // namespace vestige
