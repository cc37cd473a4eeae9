#include "analysis/batch/batch_results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string_view>

#include "analysis/scoring/scores.hpp"
#include "traces/base/error.hpp"
#include "traces/base/number_text.hpp"

namespace vestige {

namespace {

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
constexpr std::string_view kCoverage = "coverage";
constexpr std::string_view kIntervals =
    "95 %, bootstrap-t over seeds within each scenario, or over files; p: of the difference from the leader, who is "
    "chosen anew in each of 10000 paired resamples; p_holm: corrected for the number of comparisons (Holm 1979)";
constexpr std::string_view kErrorWithUnfelt = "error_with_unfelt_mm";

nlohmann::ordered_json number(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

/// Empty where there is none.
std::string field(double value) {
  return std::isfinite(value) ? fmt::format("{}", value) : "";
}

/// Mean and interval as three fields.
std::string fields(const MeanInterval& mean) {
  return fmt::format("{},{},{}", field(mean.mean), field(mean.interval.low), field(mean.interval.high));
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

/// A trace that was judged.
struct JudgedTrace {
  std::string name;
  std::string scenario;               ///< empty for a file
  std::optional<std::uint64_t> seed;  ///< of the scenario
  std::uint64_t contacts = 0;
};

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
    std::map<std::string, const nlohmann::ordered_json*> plan_of;
    for (const nlohmann::ordered_json& planned : batch.at("traces"))
      if (planned.contains("seed")) plan_of[planned.at("name").get<std::string>()] = &planned;
    for (JudgedTrace& trace : traces_) {
      const auto planned = plan_of.find(trace.name);
      if (planned == plan_of.end()) continue;
      trace.scenario = planned->second->at("given").get<std::string>();
      trace.seed = planned->second->at("seed").get<std::uint64_t>();
    }
  }

  const std::vector<BatchResults::Candidate>& candidates() const { return candidates_; }
  const std::vector<CandidateValues>& values() const { return values_; }
  const std::vector<JudgedTrace>& traces() const { return traces_; }

 private:
  void add(const nlohmann::ordered_json& item, std::size_t trace) {
    const auto name = item.at("trace").get<std::string>();
    traces_.push_back({name, "", std::nullopt, item.at("contacts").get<std::uint64_t>()});
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
  std::vector<JudgedTrace> traces_;
};

/// Calls `row` for each map, trace and law, in this order.
template <typename Row>
void for_each_score(const ScoreTable& table, std::size_t laws, const Row& row) {
  for (std::size_t first = 0; first < table.candidates().size(); first += laws)
    for (std::size_t trace = 0; trace < table.traces().size(); ++trace)
      for (std::size_t c = first; c < first + laws; ++c) row(c, trace);
}

void write_scores(const BatchFolder& folder, const ScoreTable& table, std::size_t laws) {
  std::string csv = "map,trace,law,scenario,seed,contacts";
  for (const Metric& metric : metrics()) csv += fmt::format(",{}", metric.name);
  nlohmann::ordered_json json = {{"schema_version", 1}, {"metrics", metrics_json()}};
  nlohmann::ordered_json& scores = json["scores"] = nlohmann::ordered_json::array();
  for_each_score(table, laws, [&](std::size_t c, std::size_t trace) {
    const BatchResults::Candidate& candidate = table.candidates()[c];
    const JudgedTrace& judged = table.traces()[trace];
    csv += fmt::format("\n{},{},{},{},{},{}", candidate.map, judged.name, candidate.law, judged.scenario,
                       judged.seed ? std::to_string(*judged.seed) : "", judged.contacts);
    nlohmann::ordered_json values;
    for (std::size_t m = 0; m < metrics().size(); ++m) {
      const double value = table.values()[c][m][trace];
      csv += fmt::format(",{}", field(value));
      values[std::string(metrics()[m].name)] = number(value);
    }
    nlohmann::ordered_json one = {{"map", candidate.map}, {"trace", judged.name}, {"law", candidate.law},
                                  {"scenario", nullptr},  {"seed", nullptr},      {"contacts", judged.contacts},
                                  {"values", values}};
    if (judged.seed) {
      one["scenario"] = judged.scenario;
      one["seed"] = *judged.seed;
    }
    scores.push_back(one);
  });
  write_file(folder.top("scores.csv"), csv + "\n");
  write_json_file(folder.top("scores.json"), json);
}

/// How a candidate compares with the best.
LeaderTest test_of(const RankedCandidate& ranked) {
  return ranked.against_leader.value_or(LeaderTest{kNotANumber, {kNotANumber, kNotANumber}, kNotANumber, kNotANumber});
}

std::string comparison_fields(const RankedCandidate& ranked) {
  const LeaderTest test = test_of(ranked);
  const char* worse = ranked.is_worse() ? "yes" : "no";
  return fmt::format("{},{},{},{},{},{}", field(test.difference), field(test.interval.low), field(test.interval.high),
                     field(test.p), field(test.p_holm), ranked.is_compared() ? worse : "");
}

nlohmann::ordered_json name_and_rank(const BatchResults& results, const RankedCandidate& ranked) {
  const auto& [map, law] = results.candidates[ranked.candidate];
  nlohmann::ordered_json one = {{"rank", nullptr}, {"map", map}, {"law", law}};
  if (ranked.rank) one["rank"] = *ranked.rank;
  return one;
}

void add_comparison(nlohmann::ordered_json& one, const RankedCandidate& ranked, const MeanInterval& headline) {
  const LeaderTest test = test_of(ranked);
  one["headline"] = to_json(headline);
  one["difference_from_best"] = to_json(MeanInterval{test.difference, test.interval, headline.n});
  one["difference_from_best"]["p"] = number(test.p);
  one["difference_from_best"]["p_holm"] = number(test.p_holm);
  one["distinguishable_from_best"] = ranked.is_worse();
}

void write_ranking_by_scenario(const BatchFolder& folder, const BatchResults& results) {
  const std::string_view name = metrics()[results.headline].name;
  std::string csv = fmt::format(
      "scenario,rank,map,law,traces,{0},{0}_low,{0}_high,difference_from_best,difference_low,difference_high,p,p_holm,"
      "distinguishable_from_best\n",
      name);
  for (const ScenarioRanking& scenario : results.by_scenario) {
    for (const RankedCandidate& ranked : scenario.ranking) {
      const auto& [map, law] = results.candidates[ranked.candidate];
      const MeanInterval& mean = ranked.metrics.front();
      csv += fmt::format("{},{},{},{},{},{},{}\n", scenario.scenario, ranked.rank ? std::to_string(*ranked.rank) : "",
                         map, law, mean.n, fields(mean), comparison_fields(ranked));
    }
  }
  // With one scenario, ranking.csv says it all.
  write_or_remove_file(folder.top("ranking_by_scenario.csv"), results.by_scenario.empty() ? "" : csv);
}

nlohmann::ordered_json by_scenario_json(const BatchResults& results) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const ScenarioRanking& scenario : results.by_scenario) {
    nlohmann::ordered_json ranking = nlohmann::ordered_json::array();
    for (const RankedCandidate& ranked : scenario.ranking) {
      nlohmann::ordered_json one = name_and_rank(results, ranked);
      add_comparison(one, ranked, ranked.metrics.front());
      ranking.push_back(one);
    }
    json.push_back({{"scenario", scenario.scenario}, {"traces", scenario.traces}, {"ranking", ranking}});
  }
  return json;
}

void write_ranking(const BatchFolder& folder, const BatchResults& results, std::uint64_t seed) {
  const Metric& headline = metrics()[results.headline];
  std::string csv = "rank,map,law,traces";
  for (const Metric& metric : metrics()) csv += fmt::format(",{0},{0}_low,{0}_high", metric.name);
  csv += ",difference_from_best,difference_low,difference_high,p,p_holm,distinguishable_from_best,why_no_interval\n";
  nlohmann::ordered_json json = {
      {"schema_version", 1},
      {"rank_by", headline.name},
      {"better", name_of(headline.better)},
      {"model_based", headline.model_based},
      {"traces", results.traces},
      {"seed", seed},
      {"interval", results.has_intervals() ? nlohmann::ordered_json(kIntervals) : nullptr},
      {"why_no_intervals", results.has_intervals() ? nullptr : nlohmann::ordered_json(results.why_no_intervals)},
      {"over", results.over},
      {"metrics", metrics_json()},
      {"ranking", nlohmann::ordered_json::array()}};
  for (const RankedCandidate& ranked : results.ranking) {
    const BatchResults::Candidate& candidate = results.candidates[ranked.candidate];
    csv += fmt::format("{},{},{},{}", ranked.rank ? std::to_string(*ranked.rank) : "", candidate.map, candidate.law,
                       ranked.metrics[results.headline].n);
    nlohmann::ordered_json means;
    for (std::size_t m = 0; m < metrics().size(); ++m) {
      const MeanInterval& mean = ranked.metrics[m];
      csv += "," + fields(mean);
      means[std::string(metrics()[m].name)] = to_json(mean);
    }
    const std::string why = ranked.against_leader     ? ""
                            : results.has_intervals() ? "too few traces have a value"
                                                      : results.why_no_intervals;
    csv += fmt::format(",{},{}\n", comparison_fields(ranked), why);
    nlohmann::ordered_json one = name_and_rank(results, ranked);
    one["traces"] = ranked.metrics[results.headline].n;
    add_comparison(one, ranked, ranked.metrics[results.headline]);
    one["metrics"] = means;
    json["ranking"].push_back(one);
  }
  json["by_scenario"] = by_scenario_json(results);
  json["reversals"] = results.reversals;
  write_file(folder.top("ranking.csv"), csv);
  write_json_file(folder.top("ranking.json"), json);
}

/// Traces of the same bytes count twice, and make intervals narrower than they are.
void warn_of_copies(const nlohmann::ordered_json& batch, std::span<const nlohmann::ordered_json> items,
                    std::vector<std::string>& warnings) {
  std::map<std::string, std::size_t> person_of;
  for (const nlohmann::ordered_json& planned : batch.at("traces"))
    person_of[planned.at("name").get<std::string>()] = planned.value("avatar", std::size_t{1});
  std::map<std::pair<std::string, std::size_t>, std::string> first;  // by bytes and person
  for (const nlohmann::ordered_json& item : items) {
    const auto name = item.at("trace").get<std::string>();
    const auto [place, is_new] =
        first.emplace(std::pair(item.at("trace_sha256").get<std::string>(), person_of[name]), name);
    if (!is_new)
      warnings.push_back(
          fmt::format("traces '{}' and '{}' have the same bytes, so they count twice", place->second, name));
  }
}

/// What share of a trace's contacts is felt, mean over the traces.
double coverage_of(const RankedCandidate& ranked) {
  const auto coverage = std::ranges::find(metrics(), kCoverage, &Metric::name);
  return ranked.metrics[static_cast<std::size_t>(coverage - metrics().begin())].mean;
}

/// Where the headline's means are not of the same traces, or only of what was felt.
void warn_of_gaps(BatchResults& results) {
  const Metric& headline = metrics()[results.headline];
  std::size_t least = results.traces;
  for (const RankedCandidate& ranked : results.ranking) least = std::min(least, ranked.metrics[results.headline].n);
  const bool is_all = std::ranges::all_of(
      results.ranking, [&](const RankedCandidate& ranked) { return ranked.metrics[results.headline].n == least; });
  if (least < results.traces)
    results.warnings.push_back(fmt::format(
        "{} maps and laws have a {} on {} of {} {}{}: on {}, nothing was felt, or nothing that this metric "
        "measures{}",
        is_all ? "all" : "some", headline.name, least == 0 ? "none" : std::to_string(least), results.traces,
        results.traces == 1 ? "trace" : "traces", least == 0 ? "" : " only", least == 0 ? "them" : "the others",
        least == 0 ? "" : "; their means may come from easier or harder traces"));
  if (headline.name == kCoverage || headline.name == kErrorWithUnfelt) return;
  double low = std::numeric_limits<double>::infinity();
  double high = 0;
  for (const RankedCandidate& ranked : results.ranking) {
    low = std::min(low, coverage_of(ranked));
    high = std::max(high, coverage_of(ranked));
  }
  if (low < 0.9 * high)
    results.warnings.push_back(fmt::format(
        "coverage ranges from {:.2g} to {:.2g}: contacts that are not felt do not count in {}, so a small "
        "map has an advantage; common_error_mm compares on the same contacts, and with --unfelt-mm they count",
        low, high, headline.name));
}

/// What could have been otherwise: seeds and files. The people of one file are not independent of each other, so they
/// count once, with the mean of their values.
struct Recordings {
  std::vector<std::string> names;       ///< of the traces, of several people that of the first
  std::vector<CandidateValues> values;  ///< in the order of the names
};

Recordings recordings_of(const nlohmann::ordered_json& batch, const ScoreTable& table) {
  std::map<std::string, std::string> file_of;  // of one person of several, by the trace's name
  for (const nlohmann::ordered_json& planned : batch.at("traces"))
    if (planned.contains("avatar"))
      file_of[planned.at("name").get<std::string>()] = planned.at("given").get<std::string>();
  Recordings recordings;
  std::map<std::string, std::size_t> place_of;   // by file
  std::vector<std::vector<std::size_t>> traces;  // of each recording
  for (std::size_t i = 0; i < table.traces().size(); ++i) {
    const std::string& name = table.traces()[i].name;
    const auto file = file_of.find(name);
    const auto [place, is_new] =
        file == file_of.end() ? std::pair(place_of.end(), true) : place_of.try_emplace(file->second, traces.size());
    if (is_new) {
      recordings.names.push_back(name);
      traces.push_back({i});
    } else {
      traces[place->second].push_back(i);
    }
  }
  for (const CandidateValues& all : table.values()) {
    CandidateValues& values = recordings.values.emplace_back(all.size());
    for (std::size_t m = 0; m < all.size(); ++m)
      for (const std::vector<std::size_t>& people : traces) {
        double sum = 0;
        std::size_t count = 0;
        for (const std::size_t i : people)
          if (std::isfinite(all[m][i])) {
            sum += all[m][i];
            ++count;
          }
        values[m].push_back(count == 0 ? kNotANumber : sum / static_cast<double>(count));
      }
  }
  return recordings;
}

/// Returns what tells each candidate from the others: its map, its law, or both.
std::vector<std::string> names_of(const std::vector<BatchResults::Candidate>& candidates) {
  const auto all_have = [&](const auto& part) {
    return std::ranges::all_of(candidates, [&](const auto& one) { return one.*part == candidates.front().*part; });
  };
  const bool one_map = all_have(&BatchResults::Candidate::map);
  const bool one_law = all_have(&BatchResults::Candidate::law);
  std::vector<std::string> names;
  names.reserve(candidates.size());
  for (const auto& [map, law] : candidates)
    names.push_back(one_map && !one_law ? law : one_law ? map : fmt::format("{} with {}", map, law));
  return names;
}

}  // namespace

BatchResults write_results(const BatchFolder& folder, const nlohmann::ordered_json& batch,
                           std::span<const nlohmann::ordered_json> items, std::size_t headline) {
  try {
    const ScoreTable table(batch, items);
    BatchResults results;
    results.candidates = table.candidates();
    results.headline = headline;
    const Recordings recordings = recordings_of(batch, table);
    results.traces = recordings.names.size();
    const auto seed = batch.at("options").at("seed").get<std::uint64_t>();
    const TraceGroups groups = group_traces(batch, recordings.names);
    const RankDirection direction =
        metrics()[headline].better == Better::kHigher ? RankDirection::kHigherIsBetter : RankDirection::kLowerIsBetter;
    results.ranking = rank_candidates(recordings.values, groups.strata, headline, direction, seed);
    results.over = groups.over;
    results.why_no_intervals = groups.why_no_intervals;
    std::vector<std::vector<double>> headlines;
    headlines.reserve(recordings.values.size());
    for (const CandidateValues& values : recordings.values) headlines.push_back(values[headline]);
    results.by_scenario = rank_by_scenario(headlines, groups, direction, seed);
    results.reversals = describe_reversals(results.by_scenario, results.ranking, names_of(results.candidates));
    write_scores(folder, table, batch.at("laws").size());
    write_ranking(folder, results, seed);
    write_ranking_by_scenario(folder, results);
    warn_of_copies(batch, items, results.warnings);
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
    if (m != results.headline && metrics()[m].shown == Shown::kBesideTheRank) beside.push_back(m);
  std::string text = fmt::format("{}{}{}, {} is better: {}{}\n", headline.name, *headline.unit == '\0' ? "" : ", ",
                                 headline.unit, name_of(headline.better),
                                 fmt::format("mean over the traces of {}{}", results.over,
                                             results.has_intervals() ? " and its 95 % interval" : ""),
                                 headline.model_based ? "; FROM A MODEL, NOT FROM A USER STUDY" : "");
  std::size_t width = 3;
  for (const BatchResults::Candidate& candidate : results.candidates) width = std::max(width, candidate.map.size());
  text += fmt::format("  {:>4}  {:<{}}  {:<8}  {:>28}", "rank", "map", width, "law", headline.name);
  const auto title_of = [](std::size_t m) {
    return fmt::format("{}{}", metrics()[m].name, metrics()[m].model_based ? "*" : "");
  };
  for (const std::size_t m : beside) text += fmt::format("  {}", title_of(m));
  text += results.has_intervals() ? "       p  p_holm\n" : "\n";
  bool marked = false;
  for (std::size_t i = 0; i < std::min(rows, results.ranking.size()); ++i) {
    const RankedCandidate& ranked = results.ranking[i];
    const BatchResults::Candidate& candidate = results.candidates[ranked.candidate];
    const MeanInterval& mean = ranked.metrics[results.headline];
    const bool like_best = ranked.is_compared() && !ranked.is_worse();
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
      text += fmt::format("  {:>{}}", std::isfinite(value) ? fmt::format("{:.4g}", value) : "-", title_of(m).size());
    }
    if (ranked.is_compared())
      text += fmt::format("  {:>6.4f}  {:>6.4f}", ranked.against_leader->p, ranked.against_leader->p_holm);
    text += "\n";
  }
  if (results.ranking.size() > rows)
    text += fmt::format("  ... {} more in ranking.csv\n", results.ranking.size() - rows);
  if (marked) text += "=: not distinguishable from rank 1 (p_holm, which is p by Holm's correction, is 0.05 or more)\n";
  if (!results.has_intervals())
    text += fmt::format("no intervals, and no '=': {}; another recording may turn the ranking over\n",
                        results.why_no_intervals);
  if (headline.name != kCoverage && !results.ranking.empty()) {
    const RankedCandidate& first = results.ranking.front();
    const auto& [map, law] = results.candidates[first.candidate];
    const double felt = coverage_of(first);
    if (std::isfinite(felt))
      text += fmt::format("{} with {} lets {:.0f} % of a trace's contacts be felt (coverage)\n", map, law, 100 * felt);
  }
  if (!results.reversals.empty()) text += fmt::format("{} (ranking_by_scenario.csv)\n", results.reversals);
  if (std::ranges::any_of(beside, [](std::size_t m) { return metrics()[m].model_based; }))
    text += "*: from a model, not from a user study\n";
  return text;
}

}  // namespace vestige
