#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "analysis/stress/query_file.hpp"
#include "detector/detector.hpp"
#include "detector/method.hpp"

namespace vestige {

/// What was said to a query, and what it took.
struct QueryAnswer {
  bool contact = false;
  bool decided_exactly = false;  ///< by exact arithmetic
};

/// Answers queries by one method.
using QueryResponder = std::function<QueryAnswer(const Query&)>;

/// The deciding code of `cpu` and `geometry`, on doubles. Methods: static, ccd.
QueryResponder deciding_code(Method method);

/// The slow truth, on doubles.
QueryResponder exact_truth(Method method);

/// Makes a detector of this avatar and map, which outlive it.
using DetectorMaker = std::function<std::unique_ptr<Detector>(const Avatar&, const ActuatorMap&)>;

/// A whole detector, as `replay` runs it: each query is a frame, in which an avatar of one triangle moves from one pose
/// to the next. Queries must be `rounded_to_fp32`.
QueryResponder whole_detector(const DetectorMaker& make);

/// Every coordinate rounded to nearest fp32. Throws `Error` naming file and line where one is beyond the largest.
QueryFile rounded_to_fp32(QueryFile file);

/// Whose answer is right.
enum class QueryTruth { kFile, kExact };

/// How the queries of one file, or of several together, were answered.
struct QueryScore {
  std::string name;
  std::size_t queries = 0;
  std::size_t positives = 0;  ///< true contacts
  std::size_t decided_exactly = 0;
  std::vector<std::size_t> false_positives;  ///< lines that their queries begin in
  std::vector<std::size_t> false_negatives;
  std::vector<double> cpu_us;  ///< each query's thread CPU time, the least of three tries, the clock's own included

  void add(const QueryScore& other);
  bool all_right() const { return false_positives.empty() && false_negatives.empty(); }
};

/// `progress` is called with the share done, and stops the work by returning false.
QueryScore answer_queries(const QueryFile& file, Method method, QueryTruth truth, const QueryResponder& responder,
                          const std::function<bool(double)>& progress);

/// `{queries, positives, false_positives, false_negatives, decided_exactly, median_us, p99_us, max_us}`, with `name` in
/// front where the score has one.
nlohmann::ordered_json to_json(const QueryScore& score);

/// The table for people: a row a file, and the total.
std::string query_table(std::span<const QueryScore> scores, const QueryScore& total);

}  // namespace vestige
