#include "analysis/batch/batch_results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <string_view>

#include "analysis/scoring/scores.hpp"
#include "traces/base/error.hpp"

namespace vestige {

namespace {

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
constexpr std::string_view kShownBeside[] = {"coverage", "localisation_error_mm", "information_bits"};
constexpr std::string_view kCoverage = "coverage";

nlohmann::ordered_json number(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

/// Empty where there is none.
std::string field(double value) {
  return std::isfinite(value) ? fmt::format("{}", value) : "";
}

/// Returns whether a candidate can be compared with the best at all. With one trace, it cannot.
bool is_compared(const RankedCandidate& ranked) {
  return std::isfinite(ranked.difference_from_best.interval.low);
}

nlohmann::ordered_json to_json(const MeanInterval& mean) {
  return {{"mean", number(mean.mean)},
          {"low", number(mean.interval.low)},
          {"high", number(mean.interval.high)},
          {"n", mean.n}};
}

const char* name_of(Better better) {
  switch (better) {
    case Better::kHigher:
      return "higher";
    case Better::kLower:
      return "lower";
    default:
      return "neither";
  }
}

nlohmann::ordered_json metrics_json() {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const Metric& metric : metrics())
    json.push_back({{"name", metric.name},
                    {"unit", metric.unit},
                    {"better", name_of(metric.better)},
                    {"model_based", metric.model_based},
                    {"formula", metric.formula},
                    {"source", metric.source}});
  return json;
}

/// Scores of all items by map, law, metric and trace.
class ScoreTable {
 public:
  ScoreTable(const nlohmann::ordered_json& batch, std::span<const nlohmann::ordered_json> items) {
    for (const nlohmann::ordered_json& map : batch.at("maps"))
      if (!map.at("sha256").is_null())
        for (const nlohmann::ordered_json& law : batch.at("laws"))
          candidates_.push_back({map.at("name").get<std::string>(), law.get<std::string>()});
    values_.resize(candidates_.size(),
                   CandidateValues(metrics().size(), std::vector<double>(items.size(), kNotANumber)));
    for (std::size_t i = 0; i < items.size(); ++i) add(items[i], i);
  }

  const std::vector<BatchResults::Candidate>& candidates() const { return candidates_; }
  const std::vector<CandidateValues>& values() const { return values_; }
  const std::vector<std::string>& traces() const { return traces_; }

 private:
  void add(const nlohmann::ordered_json& item, std::size_t trace) {
    const auto name = item.at("trace").get<std::string>();
    traces_.push_back(name);
    std::map<std::pair<std::string, std::string>, const nlohmann::ordered_json*> scores;
    for (const nlohmann::ordered_json& score : item.at("scores"))
      scores[{score.at("map").get<std::string>(), score.at("law").get<std::string>()}] = &score.at("values");
    for (std::size_t c = 0; c < candidates_.size(); ++c) {
      const auto found = scores.find({candidates_[c].map, candidates_[c].law});
      for (std::size_t m = 0; m < metrics().size(); ++m) {
        if (found == scores.end() || !found->second->contains(metrics()[m].name))
          throw Error(name,
                      fmt::format("has no '{}' for map {} and law {}", metrics()[m].name, candidates_[c].map,
                                  candidates_[c].law),
                      "remove its file in the folder items, and run the batch again");
        const nlohmann::ordered_json& value = (*found->second)[std::string(metrics()[m].name)];
        if (value.is_number()) values_[c][m][trace] = value.get<double>();
      }
    }
  }

  std::vector<BatchResults::Candidate> candidates_;
  std::vector<CandidateValues> values_;
  std::vector<std::string> traces_;
};

/// Calls `row` for each map, trace and law, in this order.
template <typename Row>
void for_each_score(const ScoreTable& table, std::size_t laws, const Row& row) {
  for (std::size_t first = 0; first < table.candidates().size(); first += laws)
    for (std::size_t trace = 0; trace < table.traces().size(); ++trace)
      for (std::size_t c = first; c < first + laws; ++c) row(c, trace);
}

void write_scores(const BatchFolder& folder, const ScoreTable& table, std::size_t laws) {
  std::string csv = "map,trace,law";
  for (const Metric& metric : metrics()) csv += fmt::format(",{}", metric.name);
  nlohmann::ordered_json json = {{"schema_version", 1}, {"metrics", metrics_json()}};
  nlohmann::ordered_json& scores = json["scores"] = nlohmann::ordered_json::array();
  for_each_score(table, laws, [&](std::size_t c, std::size_t trace) {
    const BatchResults::Candidate& candidate = table.candidates()[c];
    csv += fmt::format("\n{},{},{}", candidate.map, table.traces()[trace], candidate.law);
    nlohmann::ordered_json values;
    for (std::size_t m = 0; m < metrics().size(); ++m) {
      const double value = table.values()[c][m][trace];
      csv += fmt::format(",{}", field(value));
      values[std::string(metrics()[m].name)] = number(value);
    }
    scores.push_back(
        {{"map", candidate.map}, {"trace", table.traces()[trace]}, {"law", candidate.law}, {"values", values}});
  });
  write_file(folder.top("scores.csv"), csv + "\n");
  write_json_file(folder.top("scores.json"), json);
}

void write_ranking(const BatchFolder& folder, const BatchResults& results, std::uint64_t seed) {
  const Metric& headline = metrics()[results.headline];
  std::string csv = "rank,map,law,traces";
  for (const Metric& metric : metrics()) csv += fmt::format(",{0},{0}_low,{0}_high", metric.name);
  csv += ",difference_from_best,difference_low,difference_high,distinguishable_from_best\n";
  nlohmann::ordered_json json = {
      {"schema_version", 1},
      {"rank_by", headline.name},
      {"better", name_of(headline.better)},
      {"model_based", headline.model_based},
      {"traces", results.traces},
      {"seed", seed},
      {"interval",
       "95 %, paired bootstrap over the traces (expanded percentile: Hesterberg 2015); not corrected for "
       "multiple comparisons"},
      {"metrics", metrics_json()},
      {"ranking", nlohmann::ordered_json::array()}};
  for (const RankedCandidate& ranked : results.ranking) {
    const BatchResults::Candidate& candidate = results.candidates[ranked.candidate];
    csv += fmt::format("{},{},{},{}", ranked.rank ? std::to_string(*ranked.rank) : "", candidate.map, candidate.law,
                       ranked.metrics[results.headline].n);
    nlohmann::ordered_json means;
    for (std::size_t m = 0; m < metrics().size(); ++m) {
      const MeanInterval& mean = ranked.metrics[m];
      csv += fmt::format(",{},{},{}", field(mean.mean), field(mean.interval.low), field(mean.interval.high));
      means[std::string(metrics()[m].name)] = to_json(mean);
    }
    const MeanInterval& difference = ranked.difference_from_best;
    csv += fmt::format(",{},{},{},{}\n", field(difference.mean), field(difference.interval.low),
                       field(difference.interval.high),
                       !is_compared(ranked)               ? ""
                       : ranked.distinguishable_from_best ? "yes"
                                                          : "no");
    nlohmann::ordered_json one = {{"rank", nullptr}, {"map", candidate.map}, {"law", candidate.law}};
    if (ranked.rank) one["rank"] = *ranked.rank;
    one["traces"] = ranked.metrics[results.headline].n;
    one["headline"] = to_json(ranked.metrics[results.headline]);
    one["difference_from_best"] = to_json(difference);
    one["distinguishable_from_best"] = ranked.distinguishable_from_best;
    one["metrics"] = means;
    json["ranking"].push_back(one);
  }
  write_file(folder.top("ranking.csv"), csv);
  write_json_file(folder.top("ranking.json"), json);
}

/// Traces of the same bytes count twice, and make intervals narrower than they are.
void warn_of_copies(std::span<const nlohmann::ordered_json> items, std::vector<std::string>& warnings) {
  std::map<std::string, std::string> first;
  for (const nlohmann::ordered_json& item : items) {
    const auto name = item.at("trace").get<std::string>();
    const auto [place, is_new] = first.emplace(item.at("trace_sha256").get<std::string>(), name);
    if (!is_new)
      warnings.push_back(
          fmt::format("traces '{}' and '{}' have the same bytes, so they count twice", place->second, name));
  }
}

/// Where the headline's means are not of the same traces, or only of what was felt.
void warn_of_gaps(BatchResults& results) {
  const Metric& headline = metrics()[results.headline];
  std::size_t least = results.traces;
  for (const RankedCandidate& ranked : results.ranking) least = std::min(least, ranked.metrics[results.headline].n);
  if (least < results.traces)
    results.warnings.push_back(fmt::format(
        "some maps and laws have a {} on {} of {} {}{}: on {}, nothing was felt, or nothing that this metric "
        "measures{}",
        headline.name, least == 0 ? "none" : std::to_string(least), results.traces,
        results.traces == 1 ? "trace" : "traces", least == 0 ? "" : " only", least == 0 ? "them" : "the others",
        least == 0 ? "" : "; their means may come from easier or harder traces"));
  const auto coverage = std::ranges::find(metrics(), kCoverage, &Metric::name);
  if (coverage == metrics().end() || headline.name == kCoverage) return;
  const auto place = static_cast<std::size_t>(coverage - metrics().begin());
  double low = std::numeric_limits<double>::infinity();
  double high = 0;
  for (const RankedCandidate& ranked : results.ranking) {
    low = std::min(low, ranked.metrics[place].mean);
    high = std::max(high, ranked.metrics[place].mean);
  }
  if (low < 0.9 * high)
    results.warnings.push_back(
        fmt::format("coverage ranges from {:.2g} to {:.2g}: contacts that fire nothing do not count in {}, so a small "
                    "map has an advantage; read both",
                    low, high, headline.name));
}

}  // namespace

BatchResults write_results(const BatchFolder& folder, const nlohmann::ordered_json& batch,
                           std::span<const nlohmann::ordered_json> items, std::size_t headline) {
  try {
    const ScoreTable table(batch, items);
    BatchResults results;
    results.candidates = table.candidates();
    results.headline = headline;
    results.traces = items.size();
    const auto seed = batch.at("options").at("seed").get<std::uint64_t>();
    results.ranking = rank_candidates(
        table.values(), headline,
        metrics()[headline].better == Better::kHigher ? RankDirection::kHigherIsBetter : RankDirection::kLowerIsBetter,
        seed);
    write_scores(folder, table, batch.at("laws").size());
    write_ranking(folder, results, seed);
    warn_of_copies(items, results.warnings);
    warn_of_gaps(results);
    return results;
  } catch (const nlohmann::json::exception& error) {
    throw Error(folder.top("items"), fmt::format("contains a file that is not an item of a batch ({})", error.what()),
                "remove this folder, and run the batch again");
  }
}

std::string describe(const BatchResults& results, std::size_t rows) {
  const Metric& headline = metrics()[results.headline];
  std::vector<std::size_t> beside;  // what a headline alone would hide
  for (std::size_t m = 0; m < metrics().size(); ++m)
    if (m != results.headline && std::ranges::find(kShownBeside, metrics()[m].name) != std::end(kShownBeside))
      beside.push_back(m);
  std::string text =
      fmt::format("{}{}{}, {} is better: {}{}\n", headline.name, *headline.unit == '\0' ? "" : ", ", headline.unit,
                  name_of(headline.better),
                  results.traces == 1 ? "one trace: no intervals"
                                      : fmt::format("mean over {} traces and its 95 % interval", results.traces),
                  headline.model_based ? "; FROM A MODEL, NOT FROM A USER STUDY" : "");
  std::size_t width = 3;
  for (const BatchResults::Candidate& candidate : results.candidates) width = std::max(width, candidate.map.size());
  text += fmt::format("  {:>4}  {:<{}}  {:<8}  {:>28}", "rank", "map", width, "law", headline.name);
  for (const std::size_t m : beside)
    text += fmt::format("  {:>12}", fmt::format("{}{}", metrics()[m].name, metrics()[m].model_based ? "*" : ""));
  text += "\n";
  bool marked = false;
  for (std::size_t i = 0; i < std::min(rows, results.ranking.size()); ++i) {
    const RankedCandidate& ranked = results.ranking[i];
    const BatchResults::Candidate& candidate = results.candidates[ranked.candidate];
    const MeanInterval& mean = ranked.metrics[results.headline];
    const bool like_best = ranked.rank && *ranked.rank != 1 && is_compared(ranked) && !ranked.distinguishable_from_best;
    marked = marked || like_best;
    const std::string interval = std::isfinite(mean.interval.low) ? fmt::format("{:.4g} ({:.4g} to {:.4g})", mean.mean,
                                                                                mean.interval.low, mean.interval.high)
                                 : std::isfinite(mean.mean)       ? fmt::format("{:.4g}", mean.mean)
                                                                  : "nothing felt";
    text +=
        fmt::format("{} {:>4}  {:<{}}  {:<8}  {:>28}", like_best ? "=" : " ",
                    ranked.rank ? std::to_string(*ranked.rank) : "-", candidate.map, width, candidate.law, interval);
    for (const std::size_t m : beside) {
      const double value = ranked.metrics[m].mean;
      text += fmt::format("  {:>12}", std::isfinite(value) ? fmt::format("{:.4g}", value) : "-");
    }
    text += "\n";
  }
  if (results.ranking.size() > rows)
    text += fmt::format("  ... {} more in ranking.csv\n", results.ranking.size() - rows);
  if (marked)
    text += "=: not distinguishable from rank 1 on these traces (the interval of the paired difference contains 0)\n";
  if (results.traces > 1 && results.traces < kFewTraces)
    text +=
        fmt::format("{} traces are few: the intervals are rough and apply only to traces like these\n", results.traces);
  if (std::ranges::any_of(beside, [](std::size_t m) { return metrics()[m].model_based; }))
    text += "*: from a model, not from a user study\n";
  return text;
}

}  // namespace vestige
