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

/// The answer to a query, and how it was decided.
struct QueryAnswer {
  bool contact = false;
  bool decided_exactly = false;  ///< whether it needed exact arithmetic
};

/// Answers queries with one method.
using QueryResponder = std::function<QueryAnswer(const Query&)>;

/// Returns the deciding code of `cpu` and `geometry`, on doubles. `method` is static or ccd. Throws
/// `std::invalid_argument` for carried.
QueryResponder deciding_code(Method method);

/// Returns the slow exact check, on doubles. Throws `std::invalid_argument` for carried.
QueryResponder exact_truth(Method method);

/// Makes a detector for this avatar and map, which must outlive the detector.
using DetectorMaker = std::function<std::unique_ptr<Detector>(const Avatar&, const ActuatorMap&)>;

/// Returns a whole detector, as `replay` runs it. Each query is a frame in which an avatar of one triangle moves from
/// one pose to the next. Queries must be `rounded_to_fp32`. Throws `std::invalid_argument` if the method is carried.
QueryResponder whole_detector(const DetectorMaker& make);

/// Rounds every coordinate to the nearest fp32. Throws `Error` with file and line if a coordinate is beyond the largest
/// fp32.
QueryFile rounded_to_fp32(QueryFile file);

/// Which source gives the true answer.
enum class QueryTruth { kFile, kExact };

/// How the queries of one file, or of several files together, were answered.
struct QueryScore {
  std::string name;
  std::size_t queries = 0;
  std::size_t positives = 0;  ///< true contacts
  std::size_t decided_exactly = 0;
  std::vector<std::size_t> false_positives;  ///< line numbers at which these queries begin
  std::vector<std::size_t> false_negatives;
  /// Thread CPU time of each query, the least of three tries; includes the clock's own time.
  std::vector<double> cpu_us;

  void add(const QueryScore& other);
  bool all_right() const { return false_positives.empty() && false_negatives.empty(); }
};

/// Answers all queries of a file and scores the answers. `progress` receives the share done and returns false to stop.
QueryScore answer_queries(const QueryFile& file, Method method, QueryTruth truth, const QueryResponder& responder,
                          const std::function<bool(double)>& progress);

/// Returns `{queries, positives, false_positives, false_negatives, decided_exactly, median_us, p99_us, max_us}`, with
/// `name` in front if the score has a name.
nlohmann::ordered_json to_json(const QueryScore& score);

/// Returns a table for people, with a row for each file and for the total.
std::string query_table(std::span<const QueryScore> scores, const QueryScore& total);

}  // namespace vestige
