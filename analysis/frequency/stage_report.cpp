#include "analysis/frequency/stage_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <vector>

#include "analysis/frequency/sweep_report.hpp"

namespace vestige {

namespace {

constexpr std::size_t kFewPoints = 3;

std::string cell_of(double us) {
  return fmt::format("{:.{}f}", us, us < 1000 ? 2 : 0);
}

/// The row of one stage, or nothing if no series went through it.
std::string stage_row(std::span<const SweepSeries* const> series, std::size_t point, Stage stage, std::size_t width) {
  std::string row = fmt::format("\n{:>10}", kStageNames[static_cast<std::size_t>(stage)]);
  bool any = false;
  for (const SweepSeries* one : series) {
    const auto& stages = one->points[point].stages.stages;
    const auto found = std::ranges::find(stages, stage, &StageTime::stage);
    any = any || found != stages.end();
    fmt::format_to(std::back_inserter(row), "  {:>{}}", found == stages.end() ? "-" : cell_of(found->us), width);
  }
  return any ? row : "";
}

std::string stage_table_at(std::span<const SweepSeries* const> series, std::size_t point, std::size_t width) {
  const std::uint32_t colliders = series.front()->points[point].colliders;
  std::string table = fmt::format("\nWhere the time goes with {} collider{}, \u00b5s a frame:\n{:>10}", colliders,
                                  colliders == 1 ? "" : "s", "");
  for (const SweepSeries* one : series) fmt::format_to(std::back_inserter(table), "  {:>{}}", name_of(*one), width);
  for (std::size_t i = 0; i < kStageNames.size(); ++i) table += stage_row(series, point, static_cast<Stage>(i), width);
  fmt::format_to(std::back_inserter(table), "\n{:>10}", "together");
  for (const SweepSeries* one : series)
    fmt::format_to(std::back_inserter(table), "  {:>{}}", cell_of(one->points[point].stages.total_us()), width);
  return table + "\n";
}

}  // namespace

nlohmann::ordered_json to_json(const StageMeans& means) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  if (means.empty()) return json;
  for (const StageTime& time : means.stages)
    json["stages"][kStageNames[static_cast<std::size_t>(time.stage)]] = time.us;
  if (means.drawn_by != DrawnBy::kNothing) json["draw_by"] = means.drawn_by == DrawnBy::kTimer ? "timer" : "clock";
  return json;
}

std::string stage_table(std::span<const SweepSeries> series) {
  std::vector<const SweepSeries*> timed;
  for (const SweepSeries& one : series)
    if (std::ranges::none_of(one.points, [](const SweepPoint& point) { return point.stages.empty(); }))
      timed.push_back(&one);
  if (timed.empty()) return "";
  const std::size_t points = timed.front()->points.size();
  std::string table;
  bool by_clock = false;
  for (std::size_t p = points <= kFewPoints ? 0 : points - 1; p < points; ++p) {
    table += stage_table_at(timed, p, column_width(series));
    for (const SweepSeries* one : timed) by_clock = by_clock || one->points[p].stages.drawn_by == DrawnBy::kClock;
  }
  if (by_clock)
    table += "draw: by the CPU's clock until its calls return, where the driver has no timer to be believed.\n";
  return table;
}

}  // namespace vestige
