#include "analysis/plot/data/crowd_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <set>

#include "traces/base/error.hpp"
#include "traces/base/number_text.hpp"

namespace vestige::plot {

namespace {

/// With more than one plane, a detector is another one.
std::string detector_of(const SweepSeries& series) {
  return series.planes > 1 ? fmt::format("{}, {} planes", series.detector, series.planes) : series.detector;
}

/// The line of a series, which its crowds share.
GrowthLine& line_of(GrowthPanel& panel, const SweepSeries& series) {
  const std::string detector = detector_of(series);
  const auto same = std::ranges::find_if(panel.lines, [&](const GrowthLine& line) {
    return line.detector == detector && line.context == series.context && line.skip == series.skip &&
           line.first_only == series.first_only;
  });
  if (same != panel.lines.end()) return *same;
  return panel.lines.emplace_back(GrowthLine{detector, series.context, series.skip, series.first_only, {}});
}

/// Lines begin where all people have colliders: with the fewest people.
void join(GrowthPanel& panel) {
  for (GrowthLine& line : panel.lines) {
    if (!line.first_only) continue;
    const auto each = std::ranges::find_if(panel.lines, [&](const GrowthLine& other) {
      return other.detector == line.detector && other.context == line.context && other.skip == line.skip &&
             !other.first_only;
    });
    if (each != panel.lines.end() && each->points.front().size < line.points.front().size)
      line.points.insert(line.points.begin(), each->points.front());
  }
}

}  // namespace

bool has_crowds(const Sweeps& sweeps) {
  return std::ranges::any_of(sweeps.series, [&](const SweepSeries& one) {
    return one.first_only || std::ranges::any_of(sweeps.series, [&](const SweepSeries& other) {
             return other.sweep == one.sweep && other.people != one.people;
           });
  });
}

GrowthResult crowd_growth(const Sweeps& sweeps) {
  if (sweeps.sources.size() > 1)
    throw Error("INPUT", "several sweeps over the number of people do not fit into one figure", "draw each alone");
  std::set<double> counts;
  for (const SweepSeries& series : sweeps.series)
    for (const SweepPoint& point : series.points) counts.insert(point.colliders);
  GrowthResult result;
  for (const double count : counts) {
    GrowthPanel& panel = result.panels.emplace_back();
    panel.title = counted(static_cast<std::uint64_t>(count), "collider") + " around each copy";
    panel.along = "Number of people";
    for (const SweepSeries& series : sweeps.series)
      for (const SweepPoint& point : series.points)
        if (point.colliders == count) line_of(panel, series).points.push_back({series.people, 1e6 / point.hz});
    for (GrowthLine& line : panel.lines) std::ranges::sort(line.points, {}, &GrowthPoint::size);
    join(panel);
  }
  const SweepSource& source = sweeps.sources.front();
  result.legend = "Dotted: colliders around the first copy only.";
  result.renderer = source.renderer;
  result.machine = source.machine;
  result.avatar = source.avatar;
  result.commit = source.commit;
  return result;
}

}  // namespace vestige::plot
