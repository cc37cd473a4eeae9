#include "analysis/frequency/crowd_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "analysis/frequency/stage_report.hpp"
#include "analysis/frequency/sweep_report.hpp"

namespace vestige {

namespace {

constexpr std::size_t kWidth = 24;

/// What one detector did with each crowd, in the order of the crowds.
using Crowds = std::vector<const SweepSeries*>;

bool same_detector(const SweepSeries& a, const SweepSeries& b) {
  return a.detector == b.detector && a.gl.context == b.gl.context && a.skip == b.skip &&
         a.planes.count() == b.planes.count();
}

std::vector<Crowds> by_detector(std::span<const SweepSeries> series) {
  std::vector<Crowds> detectors;
  for (const SweepSeries& one : series) {
    auto same = std::ranges::find_if(detectors, [&](const Crowds& all) { return same_detector(*all.front(), one); });
    if (same == detectors.end()) same = detectors.insert(same, Crowds());
    same->push_back(&one);
  }
  return detectors;
}

/// The time with these people, and how many times that of the `fewest`.
std::string cell(const SweepPoint& point, const SweepPoint& fewest) {
  if (point.repetitions.empty()) return "-";
  const std::string us = fmt::format("{:.1f}", point.mean_us());
  return &point == &fewest || fewest.repetitions.empty()
             ? us
             : fmt::format("{} ({:.2f}x)", us, point.mean_us() / fewest.mean_us());
}

std::string table_of(const Crowds& crowds) {
  const SweepSeries& fewest = *crowds.front();
  std::string table = fmt::format("{}, µs a frame:\n{:>7}", detector_name(fewest), "people");
  for (const SweepPoint& point : fewest.points)
    for (const char* around : {"each", "around the first"})
      table += fmt::format("  {:>{}}", fmt::format("{} {}", point.colliders, around), kWidth);
  for (const SweepSeries* const each : crowds) {
    if (each->first_only) continue;
    const auto alone = std::ranges::find_if(
        crowds, [&](const SweepSeries* one) { return one->first_only && one->people == each->people; });
    table += fmt::format("\n{:>7}", each->people);
    for (std::size_t p = 0; p < fewest.points.size(); ++p) {
      table += fmt::format("  {:>{}}", cell(each->points[p], fewest.points[p]), kWidth);
      table +=
          fmt::format("  {:>{}}", alone == crowds.end() ? "-" : cell((*alone)->points[p], fewest.points[p]), kWidth);
    }
  }
  return table + "\n\n";
}

}  // namespace

bool has_crowds(std::span<const SweepSeries> series) {
  return std::ranges::any_of(series, [&](const SweepSeries& one) { return !one.same_crowd(series.front()); });
}

std::string crowd_table(std::span<const SweepSeries> series, std::uint64_t seed) {
  std::string table;
  for (const Crowds& crowds : by_detector(series)) table += table_of(crowds);
  table += "Mean time of a frame, whole round trip; in brackets: times that of the first line.\n";
  return table + throughput_table(series, seed) + stage_table(series) + disagreement_lines(series);
}

}  // namespace vestige
