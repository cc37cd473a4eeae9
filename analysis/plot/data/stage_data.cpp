#include "analysis/plot/data/stage_data.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <utility>

#include "traces/base/error.hpp"

namespace vestige::plot {

namespace {

constexpr std::size_t kMostUnasked = 3;

std::set<double> measured_counts(const Sweeps& sweeps) {
  std::set<double> counts;
  for (const SweepSeries& series : sweeps.series)
    for (const SweepPoint& point : series.points)
      if (point.stages) counts.insert(point.colliders);
  return counts;
}

std::set<double> shown_counts(const std::set<double>& measured, const std::vector<std::uint32_t>& asked,
                              const std::string& file) {
  if (asked.empty() && measured.size() <= kMostUnasked) return measured;
  if (asked.empty())
    return {*measured.begin(), *std::next(measured.begin(), static_cast<std::ptrdiff_t>(measured.size() / 2)),
            *measured.rbegin()};
  for (const std::uint32_t count : asked)
    if (!measured.contains(count))
      throw Error("--counts", fmt::format("{} has no stages with {} colliders", file, count),
                  fmt::format("choose among {}", fmt::join(measured, ", ")));
  return {asked.begin(), asked.end()};
}

std::string details_of(const SweepSeries& series, const Sweeps& sweeps) {
  std::vector<std::string> details;
  const auto differs = [&](auto SweepSeries::*setting) {
    return std::ranges::any_of(sweeps.series, [&](const SweepSeries& one) {
      return one.detector == series.detector && one.*setting != series.*setting;
    });
  };
  if (series.approximate) details.emplace_back("approximate");
  if (series.people > 1) details.push_back(fmt::format("{} people", series.people));
  if (series.first_only) details.emplace_back("colliders around the first");
  if (!series.context.empty()) details.push_back(series.context);
  if (series.skip == "on") details.emplace_back("skipping");
  if (series.skip == "off" && differs(&SweepSeries::skip)) details.emplace_back("no skipping");
  if (differs(&SweepSeries::method)) details.push_back(series.method);
  if (differs(&SweepSeries::planes))
    details.push_back(fmt::format("{} plane{}", series.planes, series.planes == 1 ? "" : "s"));
  return fmt::format("{}", fmt::join(details, ", "));
}

}  // namespace

StageResult read_stage_result(const std::filesystem::path& path, const std::vector<std::uint32_t>& counts) {
  const Sweeps sweeps = read_sweeps({path});
  const std::set<double> measured = measured_counts(sweeps);
  if (measured.empty()) throw Error(path.string(), "has no times of stages", "measure with 'vestige sweep --stages'");
  const std::set<double> shown = shown_counts(measured, counts, path.string());
  StageResult result = {sweeps.sources.front(), {}};
  for (const SweepSeries& series : sweeps.series) {
    StageGroup group = {series.detector, details_of(series, sweeps), {}};
    for (const SweepPoint& point : series.points)
      if (point.stages && shown.contains(point.colliders)) group.bars.push_back({point.colliders, *point.stages});
    if (!group.bars.empty()) result.groups.push_back(std::move(group));
  }
  return result;
}

}  // namespace vestige::plot
