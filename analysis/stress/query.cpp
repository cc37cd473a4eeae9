#include "analysis/stress/query.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <stdexcept>

#include "analysis/base/clocks.hpp"
#include "analysis/base/statistics.hpp"
#include "analysis/stress/loose_triangles.hpp"
#include "detector/truth/truth.hpp"
#include "traces/base/error.hpp"

namespace vestige {

namespace {

constexpr int kTries = 3;

void refuse_carried(Method method) {
  if (method == Method::kCarried) throw std::invalid_argument("queries have no method 'carried'");
}

LooseTriangle as_loose(const Corners& corners) {
  return {glm::vec3(corners.a), glm::vec3(corners.b), glm::vec3(corners.c)};
}

/// Everything needed to answer queries one after another. The detector refers to the other members.
struct Kernel {
  Avatar avatar = loose_triangles(1);
  ActuatorMap map;
  std::unique_ptr<Detector> detector;
  ContactRow row;

  QueryAnswer answer(const Query& query) {
    const LooseTriangle before = as_loose(query.before);
    const LooseTriangle after = as_loose(query.after);
    const Segment segment = {0, glm::vec3(query.way.start), glm::vec3(query.way.end)};
    const DetectorFrame frame = loose_frame(std::span(&before, 1), std::span(&after, 1), {segment});
    const DetectorWork work = detector->detect(frame, row);
    return {row[0].hit(), work.unsure > 0};
  }
};

}  // namespace

QueryResponder deciding_code(Method method) {
  refuse_carried(method);
  return [method](const Query& query) -> QueryAnswer {
    const Decision decision = method == Method::kCcd ? decide_ccd(query.way, query.before, query.after)
                                                     : decide_static(query.way, query.after);
    return {decision.contact.has_value(), decision.exact_arithmetic};
  };
}

QueryResponder exact_truth(Method method) {
  refuse_carried(method);
  return [method](const Query& query) -> QueryAnswer {
    const auto contact = method == Method::kCcd ? exact::ccd_contact(query.way, query.before, query.after)
                                                : exact::static_contact(query.way, query.after);
    return {contact.has_value(), true};
  };
}

QueryResponder whole_detector(const DetectorMaker& make) {
  auto kernel = std::make_shared<Kernel>();
  kernel->detector = make(kernel->avatar, kernel->map);
  refuse_carried(kernel->detector->method());
  return [kernel](const Query& query) { return kernel->answer(query); };
}

QueryFile rounded_to_fp32(QueryFile file) {
  for (Query& query : file.queries) {
    for (glm::dvec3* point : {&query.way.start, &query.way.end, &query.before.a, &query.before.b, &query.before.c,
                              &query.after.a, &query.after.b, &query.after.c}) {
      for (int axis = 0; axis < 3; ++axis) {
        const auto rounded = static_cast<float>((*point)[axis]);
        if (!std::isfinite(rounded))
          throw Error(fmt::format("{}, line {}", file.name, query.line),
                      "a coordinate of this query is beyond the largest fp32 number",
                      "leave --round-fp32 out, or scale the query");
        (*point)[axis] = static_cast<double>(rounded);
      }
    }
  }
  return file;
}

void QueryScore::add(const QueryScore& other) {
  queries += other.queries;
  positives += other.positives;
  decided_exactly += other.decided_exactly;
  std::ranges::copy(other.false_positives, std::back_inserter(false_positives));
  std::ranges::copy(other.false_negatives, std::back_inserter(false_negatives));
  std::ranges::copy(other.cpu_us, std::back_inserter(cpu_us));
}

QueryScore answer_queries(const QueryFile& file, Method method, QueryTruth truth, const QueryResponder& responder,
                          const std::function<bool(double)>& progress) {
  QueryScore score;
  score.name = file.name;
  score.cpu_us.reserve(file.queries.size());
  const QueryResponder exact = exact_truth(method);
  for (const Query& query : file.queries) {
    QueryAnswer answer;
    double least_us = std::numeric_limits<double>::infinity();
    for (int attempt = 0; attempt < kTries; ++attempt) {
      const double start_s = thread_cpu_s();
      answer = responder(query);
      least_us = std::min(least_us, 1e6 * (thread_cpu_s() - start_s));
    }
    const bool expected = truth == QueryTruth::kFile ? query.truth : exact(query).contact;
    ++score.queries;
    if (expected) ++score.positives;
    if (answer.decided_exactly) ++score.decided_exactly;
    if (answer.contact && !expected) score.false_positives.push_back(query.line);
    if (!answer.contact && expected) score.false_negatives.push_back(query.line);
    score.cpu_us.push_back(least_us);
    if (!progress(static_cast<double>(score.queries) / static_cast<double>(file.queries.size()))) break;
  }
  return score;
}

nlohmann::ordered_json to_json(const QueryScore& score) {
  nlohmann::ordered_json json;
  if (!score.name.empty()) json["name"] = score.name;
  json["queries"] = score.queries;
  json["positives"] = score.positives;
  json["false_positives"] = score.false_positives.size();
  json["false_negatives"] = score.false_negatives.size();
  json["decided_exactly"] = score.decided_exactly;
  json["median_us"] = quantile(score.cpu_us, 0.5);
  json["p99_us"] = quantile(score.cpu_us, 0.99);
  json["max_us"] = quantile(score.cpu_us, 1);
  return json;
}

std::string query_table(std::span<const QueryScore> scores, const QueryScore& total) {
  constexpr std::string_view kTotal = "total";
  std::size_t width = kTotal.size();
  for (const QueryScore& score : scores) width = std::max(width, score.name.size());
  std::string table =
      fmt::format("{:<{}}  queries      true  false +  false -  exactly  median us   p99 us   max us\n", "file", width);
  const auto add = [&](std::string_view name, const QueryScore& score) {
    fmt::format_to(
        std::back_inserter(table), "{:<{}}  {:>7}  {:>8}  {:>7}  {:>7}  {:>7}  {:>9.2f}  {:>7.1f}  {:>7.1f}\n", name,
        width, score.queries, score.positives, score.false_positives.size(), score.false_negatives.size(),
        score.decided_exactly, quantile(score.cpu_us, 0.5), quantile(score.cpu_us, 0.99), quantile(score.cpu_us, 1));
  };
  for (const QueryScore& score : scores) add(score.name, score);
  add(kTotal, total);
  return table +
         "true: contacts that exist. false +: found, but none exists. false -: missed. exactly: decided by exact "
         "arithmetic.\nus: thread CPU time, the least of three tries.\n";
}

}  // namespace vestige
