#include "analysis/compare/compare_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "traces/base/number_text.hpp"

namespace vestige {

namespace {

constexpr std::array<SpeedVerdict, 4> kVerdicts = {SpeedVerdict::kSlower, SpeedVerdict::kFaster, SpeedVerdict::kSame,
                                                   SpeedVerdict::kUnclear};

nlohmann::ordered_json null_if_missing(double value) {
  return std::isnan(value) ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(value);
}

nlohmann::ordered_json point_json(const ComparedPoint& point) {
  return {{"name", point.name},
          {"verdict", name_of(point.verdict)},
          {"ratio", point.ratio.ratio},
          {"low", null_if_missing(point.ratio.low)},
          {"high", null_if_missing(point.ratio.high)},
          {"hz_a", point.a.typical_hz()},
          {"hz_b", point.b.typical_hz()},
          {"passes_a", point.a.time.passes},
          {"passes_b", point.b.time.passes},
          {"same_answers", point.same_answers()}};
}

std::string interval_text(const SpeedRatio& ratio) {
  if (std::isnan(ratio.low)) return "-";
  return fmt::format("{:.3f} to {:.3f}", ratio.low, ratio.high);
}

}  // namespace

nlohmann::ordered_json to_json(const SweepComparison& comparison) {
  nlohmann::ordered_json points = nlohmann::ordered_json::array();
  for (const ComparedPoint& point : comparison.points) points.push_back(point_json(point));
  nlohmann::ordered_json counts;
  for (const SpeedVerdict verdict : kVerdicts) counts[name_of(verdict)] = comparison.count(verdict);
  return {{"changes", comparison.changes},
          {"counts", counts},
          {"points", points},
          {"only_a", comparison.only_a},
          {"only_b", comparison.only_b}};
}

std::string comparison_table(const SweepComparison& comparison, double threshold) {
  std::size_t width = 5;
  for (const ComparedPoint& point : comparison.points) width = std::max(width, point.name.size());
  std::string table;
  const auto out = std::back_inserter(table);
  for (const std::string& change : comparison.changes) fmt::format_to(out, "{}\n", change);
  fmt::format_to(out, "{:{}}  {:>9}  {:>9}  {:>7}  {:>16}  verdict\n", "point", width, "A, Hz", "B, Hz", "B / A",
                 "95 % interval");
  for (const ComparedPoint& point : comparison.points)
    fmt::format_to(out, "{:{}}  {:>9.0f}  {:>9.0f}  {:>7.3f}  {:>16}  {}{}\n", point.name, width, point.a.typical_hz(),
                   point.b.typical_hz(), point.ratio.ratio, interval_text(point.ratio), name_of(point.verdict),
                   point.same_answers() ? "" : ", other contacts");
  table += "Hz: of the lower quartile of each frame's durations, which leaves out what other programs added.\n";
  fmt::format_to(out, "{}: ", counted(comparison.points.size(), "point"));
  for (const SpeedVerdict verdict : kVerdicts)
    fmt::format_to(out, "{}{} {}", verdict == kVerdicts.front() ? "" : ", ", comparison.count(verdict),
                   name_of(verdict));
  fmt::format_to(out, " (by more than {:g} %)\n", 100 * threshold);
  if (!comparison.only_a.empty() || !comparison.only_b.empty())
    fmt::format_to(out, "not compared: {} only in A, {} only in B\n", counted(comparison.only_a.size(), "point"),
                   counted(comparison.only_b.size(), "point"));
  return table;
}

std::vector<std::string> comparison_warnings(const SweepComparison& comparison) {
  std::vector<std::string> warnings;
  const auto all = counted(comparison.points.size(), "point");
  const auto others = std::ranges::count_if(comparison.points, [](const auto& point) { return !point.same_answers(); });
  if (others != 0)
    warnings.push_back(
        fmt::format("at {} of {} the contacts differ: B does other work than A, or does it otherwise, and the ratio is "
                    "no matter of speed alone. If both measured the same trace, 'vestige replay --verify' says which "
                    "contacts differ.",
                    others, all));
  const auto few = std::ranges::count_if(comparison.points, [](const auto& point) {
    return std::min(point.a.time.passes, point.b.time.passes) < kFewestPasses;
  });
  if (few != 0)
    warnings.push_back(
        fmt::format("at {} of {} a frame was repeated fewer than {} times, so that no verdict is possible: measure "
                    "both again with a longer --min-time, or with fewer --run-frames.",
                    few, all, kFewestPasses));
  const auto scattered = std::ranges::count_if(comparison.points, [](const auto& point) {
    return std::max(point.a.time.scatter, point.b.time.scatter) > kMostScatter;
  });
  if (scattered != 0)
    warnings.push_back(
        fmt::format("at {} of {} the repetitions of a frame scatter too much for a verdict: close other programs and "
                    "measure again.",
                    scattered, all));
  return warnings;
}

}  // namespace vestige
