#include "analysis/plot/report/findings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "analysis/base/html.hpp"
#include "analysis/plot/canvas/axis.hpp"
#include "analysis/plot/data/report_words.hpp"
#include "traces/base/number_text.hpp"

namespace vestige::plot {

namespace {

constexpr std::size_t kMostNamed = 12;

std::string listed_html(const std::vector<std::string>& words) {
  return html_text(listed(words));
}

/// The same in brackets. Nothing if there are too many to read.
std::string in_brackets(const std::vector<std::string>& words) {
  return words.size() > kMostNamed ? "" : fmt::format(" ({})", listed_html(words));
}

std::string with_unit(double value, const ReportMetric& metric) {
  return html_text(number_text(value) + (metric.unit.empty() ? "" : "\u00a0" + metric.unit));
}

std::string name_of(const Candidate& candidate) {
  return fmt::format("{} with {}", candidate.map, candidate.law);
}

/// Returns those of rank 1.
std::vector<std::string> firsts(const std::vector<Candidate>& ranking) {
  std::vector<std::string> names;
  for (const Candidate& one : ranking)
    if (one.rank == 1U) names.push_back(name_of(one));
  return names;
}

/// "seeds 1 to 20 of each", "seed 1", "19 or 20 seeds of each"
std::string seeds_in_words(const std::map<std::string, std::set<double>>& seeds_of) {
  const std::set<double>& seeds = seeds_of.begin()->second;
  const bool same = std::ranges::all_of(seeds_of, [&](const auto& one) { return one.second == seeds; });
  const std::string each = seeds_of.size() > 1 ? " of each" : "";
  if (!same) {
    std::set<std::size_t> counts;
    for (const auto& one : seeds_of) counts.insert(one.second.size());
    return *counts.begin() == *counts.rbegin()
               ? fmt::format("{}{}", counted(*counts.begin(), "seed"), each)
               : fmt::format("{} to {} seeds{}", *counts.begin(), *counts.rbegin(), each);
  }
  if (seeds.size() == 1) return fmt::format("seed {:.0f}{}", *seeds.begin(), each);
  const bool in_a_row = *seeds.rbegin() - *seeds.begin() + 1 == static_cast<double>(seeds.size());
  if (in_a_row && seeds.size() > 2)
    return fmt::format("seeds {:.0f} to {:.0f}{}", *seeds.begin(), *seeds.rbegin(), each);
  if (seeds.size() > kMostNamed) return fmt::format("{} seeds{}", seeds.size(), each);
  std::vector<std::string> numbers;
  numbers.reserve(seeds.size());
  for (const double seed : seeds) numbers.push_back(fmt::format("{:.0f}", seed));
  return fmt::format("seeds {}{}", listed_html(numbers), each);
}

/// Which traces, and how to call them afterwards.
struct TraceWords {
  std::string all;    ///< "6 scenarios (swarm and hug; seeds 1 to 20 of each)"
  std::string these;  ///< "these scenarios"
};

TraceWords traces_in_words(const ReportData& data) {
  std::map<std::string, std::set<double>> seeds_of;
  std::vector<std::string> scenarios;
  std::vector<std::string> files;
  for (const ReportTrace& trace : data.traces) {
    if (!trace.seed) {
      files.push_back(trace.name);
      continue;
    }
    if (!seeds_of.contains(trace.given)) scenarios.push_back(trace.given);
    seeds_of[trace.given].insert(*trace.seed);
  }
  const std::string recorded = counted(files.size(), "recorded file") + in_brackets(files);
  if (scenarios.empty()) return {recorded, files.size() == 1 ? "this file" : "these files"};
  const std::string made = fmt::format("{} ({}; {})", counted(scenarios.size(), "scenario"), listed_html(scenarios),
                                       seeds_in_words(seeds_of));
  if (files.empty()) return {made, scenarios.size() == 1 ? "this scenario" : "these scenarios"};
  return {fmt::format("{} and {}", made, recorded), "these scenarios and files"};
}

/// "with the approximate detector boxes, "; nothing if contacts are exact.
std::string approximately(const ReportData& data) {
  if (!data.approximate) return "";
  if (data.detector.empty()) return "with an approximate detector, ";
  return fmt::format("with the approximate detector {}, ", html_text(data.detector));
}

/// "; on average it let 54.2 % of a trace's contacts be felt"
std::string felt_in_words(const ReportData& data, const Candidate& candidate) {
  const auto felt = data.felt_share(candidate);
  if (!felt) return "";
  return fmt::format("; {} let {:.1f}\u00a0% of {} contacts be felt", data.traces.size() == 1 ? "it" : "on average it",
                     100 * *felt, data.traces.size() == 1 ? "the" : "a trace's");
}

/// Returns by how much the seeds must be more so that a difference of this size would show; none if there is none.
std::optional<double> seeds_factor(const Estimate& difference) {
  if (!difference.has_interval() || *difference.mean == 0) return std::nullopt;
  const double size = std::abs(*difference.mean);
  const double width = std::max(std::abs(*difference.high), std::abs(*difference.low)) - size;
  return std::max(1.0, width * width / (size * size));
}

/// What the p of a difference are: "p 0.0003, by Holm's correction 0.001".
std::string p_in_words(const Candidate& one) {
  if (!one.p || !one.p_holm) return "";
  return fmt::format("; p {}, by Holm's correction {}", p_text(*one.p), p_text(*one.p_holm));
}

std::string of_more_traces(const ReportData& data) {
  const ReportMetric& metric = data.metrics[data.headline];
  const auto next = std::ranges::find_if(data.ranking, [](const Candidate& one) { return one.rank && *one.rank > 1; });
  if (!data.has_intervals())
    return fmt::format(
        "<strong>More traces.</strong> Whether more seeds or files would change the order cannot be "
        "said{}. Intervals need eight files, or five seeds of each scenario and more "
        "(<code>vestige batch --seeds 1:20</code>).",
        data.why_no_intervals.empty() ? "" : ": " + html_text(data.why_no_intervals));
  if (next == data.ranking.end()) return "";
  const Estimate& difference = next->difference_from_best;
  if (!difference.has_interval()) return "";
  std::string text = fmt::format(
      "<strong>More seeds or files.</strong> The next, {}, is {} behind (95\u00a0% interval {} "
      "to {}{}). ",
      html_text(name_of(*next)), with_unit(std::abs(*difference.mean), metric),
      number_text(std::min(std::abs(*difference.low), std::abs(*difference.high))),
      number_text(std::max(std::abs(*difference.low), std::abs(*difference.high))), p_in_words(*next));
  if (next->distinguishable_from_best) return text + "More of the same kind would hardly change who is first.";
  text += "The two cannot be told apart, so more of the same kind may put another first.";
  constexpr double kMostTimes = 100;
  if (const auto factor = seeds_factor(difference); factor && *factor <= kMostTimes)
    text += fmt::format(" If the difference is as large as it looks, about {:.0f} times as many would show it.",
                        std::max(2.0, std::ceil(*factor)));
  return text;
}

std::string of_other_scenarios(const ReportData& data) {
  std::string text = "<strong>Other scenarios.</strong> ";
  if (data.by_scenario.empty())
    return text + "The order holds for these traces; scenarios of another kind may change it.";
  const Candidate& first = data.ranking.front();
  std::size_t others = 0;
  std::size_t clear = 0;
  for (const ReportScenario& scenario : data.by_scenario) {
    const Candidate* alone = scenario.find(first);
    if (alone->rank == 1U || !scenario.ranking.front().rank) continue;
    ++others;
    if (alone->distinguishable_from_best) ++clear;
  }
  const std::string kinds = counted(data.by_scenario.size(), "scenario");
  if (others == 0)
    text += fmt::format("{} is first on each of the {} alone.", html_text(name_of(first)), kinds);
  else
    text += fmt::format("{} is first over all, but not on {} of the {} alone; {}.", html_text(name_of(first)), others,
                        kinds,
                        clear == 0 ? "on none of them is it distinguishably behind"
                                   : fmt::format("it is distinguishably behind on {} of them", clear));
  if (!data.reversals.empty()) text += fmt::format(" In detail: {}.", html_text(data.reversals));
  return text + " A batch of other scenarios may have another first: the intervals do not cover that.";
}

std::string of_other_metrics(const ReportData& data) {
  const Candidate& first = data.ranking.front();
  std::vector<std::string> others;
  std::size_t judged = 0;
  for (std::size_t m = 0; m < data.metrics.size(); ++m) {
    const ReportMetric& metric = data.metrics[m];
    if (m == data.headline || metric.better == "neither" || !first.metrics[m].mean) continue;
    const double sign = metric.better == "higher" ? -1 : 1;
    ++judged;
    if (std::ranges::any_of(data.ranking, [&](const Candidate& one) {
          return one.metrics[m].mean && sign * *one.metrics[m].mean < sign * *first.metrics[m].mean;
        }))
      others.push_back(words_of_name(metric.name));
  }
  if (judged == 0) return "";
  if (others.empty())
    return fmt::format("<strong>Another metric.</strong> {} has the best mean by every other metric ({}) too.",
                       html_text(name_of(first)), judged);
  return fmt::format("<strong>Another metric.</strong> By {} of {} other metrics, another has a better mean: {}.",
                     others.size(), judged, listed_html(others));
}

std::string of_motors(const ReportData& data) {
  if (data.actuator.empty())
    return "<strong>Motors.</strong> Here they follow their commands at once. Real ones start late and are weaker: "
           "<code>--actuator FILE.json</code> judges with them, and whether the order stays is not known before.";
  return fmt::format("<strong>Motors.</strong> They are as {} describes them; others may change the result.",
                     html_text(data.actuator));
}

/// What an error alone would hide: it counts only contacts that are felt.
std::string more_coverage(const ReportData& data) {
  const ReportMetric& headline = data.metrics[data.headline];
  const Candidate& best = data.ranking.front();
  const auto felt = data.felt_share(best);
  if (!felt || headline.name == "coverage" || headline.name == "error_with_unfelt_mm") return {};
  const Candidate* most = &best;
  for (const Candidate& one : data.ranking)
    if (data.felt_share(one).value_or(0) > data.felt_share(*most).value_or(0)) most = &one;
  constexpr double kWorthSaying = 0.005;
  const double felt_most = *data.felt_share(*most);
  if (felt_most < *felt + kWorthSaying) return {};
  return fmt::format(
      "{} lets {:.1f}\u00a0% of a trace's contacts be felt on average, {} lets {:.1f}\u00a0%; {} says nothing about "
      "the contacts that are not felt. Common error compares all on the same contacts, and <code>--unfelt-mm</code> "
      "counts what is not felt.",
      html_text(name_of(best)), 100 * *felt, html_text(name_of(*most)), 100 * felt_most,
      html_text(words_of_name(headline.name)));
}

std::string worse_in_words(const ReportData& data, std::size_t worse, const std::string& combinations) {
  if (!data.has_intervals())
    return fmt::format("Whether the {} {} {} worse on other recordings, these traces cannot show.", worse, combinations,
                       worse == 1 ? "is" : "are");
  const auto level =
      std::ranges::count_if(data.ranking, [](const Candidate& one) { return one.is_level() && one.rank != 1U; });
  if (level > 0) return fmt::format("Of the {} {}, {} cannot be distinguished from it.", worse, combinations, level);
  const std::string all =
      worse == 1 ? fmt::format("The {} is", combinations) : fmt::format("All {} {} are", worse, combinations);
  return fmt::format("{} worse (p by Holm's correction under 0.05).", all);
}

}  // namespace

std::string quotable_sentence(const ReportData& data) {
  const ReportMetric& metric = data.metrics[data.headline];
  const Candidate& first = data.ranking.front();
  const std::string words = html_text(words_of_name(metric.name));
  if (!first.headline.mean)
    return sentence_case(
        fmt::format("{}no combination of map and law has a value of {} on any trace, so nothing is ranked.",
                    approximately(data), words));
  const TraceWords traces = traces_in_words(data);
  const std::vector<std::string> best = firsts(data.ranking);
  const std::vector<std::string> maps = data.maps();
  std::string text =
      fmt::format("Over {}, {}<strong>{}</strong> had the {} {}{}", traces.all, approximately(data),
                  best.empty() ? html_text(name_of(first)) : listed_html(best),
                  metric.better == "higher" ? "highest" : "lowest", metric.model_based ? "modelled " : "", words);
  if (data.ranking.size() > 1)
    text += fmt::format(" of {} combinations of {}{} and {}{}", data.ranking.size(), counted(maps.size(), "map"),
                        in_brackets(maps), counted(data.laws.size(), "intensity law"), in_brackets(data.laws));
  text += fmt::format(": {}{}", with_unit(*first.headline.mean, metric), data.traces.size() == 1 ? "" : " on average");
  if (first.headline.has_interval())
    text += fmt::format(" over {} (95\u00a0% interval {} to {})", traces.these, number_text(*first.headline.low),
                        with_unit(*first.headline.high, metric));
  else if (data.traces.size() > 1)
    text += fmt::format(" over {} (without an interval)", traces.these);
  if (first.headline.traces < data.traces.size())
    text += fmt::format(", on the {} of {} traces where it has a value", first.headline.traces, data.traces.size());
  return text + (best.size() > 1 ? "" : felt_in_words(data, first)) + ".";
}

std::string others_in_words(const ReportData& data) {
  if (data.ranking.size() == 1) return "There is nothing else to compare it with.";
  const std::size_t equal = firsts(data.ranking).size() - 1;
  const auto ranked = static_cast<std::size_t>(
      std::ranges::count_if(data.ranking, [](const Candidate& one) { return one.rank.has_value(); }));
  const std::size_t worse = ranked - 1 - equal;
  const std::size_t without = data.ranking.size() - ranked;
  std::vector<std::string> sentences;
  if (equal > 0) sentences.push_back(fmt::format("{} other {} the same value.", equal, equal == 1 ? "has" : "have"));
  if (worse > 0)
    sentences.push_back(worse_in_words(
        data, worse,
        fmt::format("{} combination{} of map and law", equal > 0 ? "remaining" : "other", worse == 1 ? "" : "s")));
  if (without > 0) sentences.push_back(fmt::format("{} {} no value.", without, without == 1 ? "has" : "have"));
  return fmt::format("{}", fmt::join(sentences, " "));
}

std::vector<std::string> cautions(const ReportData& data) {
  const ReportMetric& headline = data.metrics[data.headline];
  std::vector<std::string> all;
  if (!data.shard.empty())
    all.push_back(fmt::format("This is shard {} of the batch: 'vestige batch merge' joins them.", data.shard));
  if (!data.complete) all.emplace_back("The batch was stopped before its end; this page shows only a part of it.");
  if (!data.failures.empty())
    all.push_back(fmt::format("{} could not be used and {} left out (<a href=\"#failures\">Failures</a>).",
                              counted(data.failures.size(), "input"), data.failures.size() == 1 ? "is" : "are"));
  const auto damaged = std::ranges::count_if(data.traces, [](const ReportTrace& one) { return !one.damage.empty(); });
  if (damaged != 0)
    all.push_back(fmt::format("{} damaged; only the part of {} that could be read counts.",
                              damaged == 1 ? "One trace is" : fmt::format("{} traces are", damaged),
                              damaged == 1 ? "it" : "them"));
  if (!data.has_intervals())
    all.push_back(fmt::format("There are no intervals{}. Another recording may turn the ranking over.",
                              data.why_no_intervals.empty() ? "" : ": " + html_text(data.why_no_intervals)));
  if (const auto more = more_coverage(data); !more.empty()) all.push_back(more);
  if (headline.model_based)
    all.push_back(
        fmt::format("{} is a model, not a user study.", html_text(sentence_case(words_of_name(headline.name)))));
  return all;
}

std::vector<std::string> what_would_change(const ReportData& data) {
  std::vector<std::string> paragraphs;
  if (!data.ranking.front().headline.mean) return paragraphs;
  for (std::string& one :
       std::vector{of_more_traces(data), of_other_scenarios(data), of_other_metrics(data), of_motors(data)})
    if (!one.empty()) paragraphs.push_back(std::move(one));
  return paragraphs;
}

}  // namespace vestige::plot
