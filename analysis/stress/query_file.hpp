#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "detector/decision.hpp"

namespace vestige {

/// The question whether a moving point meets a triangle, which may move or be at rest.
struct Query {
  Way way;
  Corners before;
  Corners after;
  bool truth = false;    ///< the file's answer
  std::size_t line = 0;  ///< line in the file
};

/// kPointTriangle: the triangle moves, so the file's truth is that of `ccd`. kSegmentTriangle: the triangle is at rest.
enum class QueryKind { kPointTriangle, kSegmentTriangle };

struct QueryFile {
  std::string name;
  QueryKind kind = QueryKind::kPointTriangle;
  std::vector<Query> queries;
  bool ends_in_newline = true;  ///< false: the last number of the file may be cut off
};

/// What to do with coordinates that no double equals. After rounding, a detector sees other coordinates than the file's
/// truth is about.
enum class Inexact { kRefuse, kRound };

/// Reads a file in one of two formats.
///
/// Without a header, a query has eight rows: the point and the triangle's three corners at t = 0, then the same at t =
/// 1. Each row has seven whole numbers: x, y, z as numerator and denominator, and the truth, 0 or 1. This is the format
/// of the public sets of Wang et al. 2021, A Large Scale Benchmark and an Inclusion-Based Algorithm for Continuous
/// Collision Detection.
///
/// With the header "source,query,gt,float_exact,px,...,cz", a query is one row: a segment from p to q and a triangle a,
/// b, c in hexadecimal doubles, with the truth in `gt`.
///
/// Throws `Error` with file and line for a malformed row, a denominator of zero, a number that is not finite, a number
/// that no double equals (with kRefuse), a query that is cut off, a query with two truths, or a file without queries.
QueryFile read_query_file(const std::filesystem::path& path, Inexact inexact);

/// As `read_query_file`, but reads `text`. `name` is the file's name in errors.
QueryFile parse_queries(std::string_view text, const std::string& name, Inexact inexact);

}  // namespace vestige
