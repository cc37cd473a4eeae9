#include "analysis/frequency/stage_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <string_view>
#include <vector>

#include "analysis/frequency/sweep_report.hpp"
#include "traces/base/number_text.hpp"

namespace vestige {

namespace {

constexpr std::size_t kFewPoints = 3;

std::string cell_of(double us) {
  return fmt::format("{:.{}f}", us, us < 1000 ? 2 : 0);
}

/// What one series spent in a stage; empty if it did not go through it.
std::string cell_of(const SweepSeries& series, std::size_t point, Stage stage) {
  const auto& stages = series.points[point].stages.stages;
  const auto found = std::ranges::find(stages, stage, &StageTime::stage);
  return found == stages.end() ? "" : cell_of(found->us);
}

/// One row for each series, one column for each stage that any of them went through.
std::string stage_table_at(std::span<const SweepSeries* const> series, std::size_t point) {
  std::size_t name_width = 0;
  for (const SweepSeries* one : series) name_width = std::max(name_width, name_of(*one).size());
  std::string head = fmt::format("{:>{}}", "", name_width);
  std::vector<std::string> rows;
  for (const SweepSeries* one : series) rows.push_back(fmt::format("{:>{}}", name_of(*one), name_width));
  const auto add_column = [&](std::string_view name, const auto& text_of) {
    const std::size_t width = std::max<std::size_t>(name.size(), 6);
    fmt::format_to(std::back_inserter(head), "  {:>{}}", name, width);
    for (std::size_t i = 0; i < series.size(); ++i) {
      const std::string text = text_of(*series[i]);
      fmt::format_to(std::back_inserter(rows[i]), "  {:>{}}", text.empty() ? "-" : text, width);
    }
  };
  for (std::size_t i = 0; i < kStageNames.size(); ++i) {
    const auto text_of = [&](const SweepSeries& one) { return cell_of(one, point, static_cast<Stage>(i)); };
    if (std::ranges::any_of(series, [&](const SweepSeries* one) { return !text_of(*one).empty(); }))
      add_column(kStageNames[i], text_of);
  }
  add_column("together", [&](const SweepSeries& one) { return cell_of(one.points[point].stages.total_us()); });
  const std::uint32_t colliders = series.front()->points[point].colliders;
  return fmt::format("\nWhere the time goes with {}, \u00b5s a frame:\n{}\n{}\n", counted(colliders, "collider"), head,
                     fmt::join(rows, "\n"));
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
    table += stage_table_at(timed, p);
    for (const SweepSeries* one : timed) by_clock = by_clock || one->points[p].stages.drawn_by == DrawnBy::kClock;
  }
  if (by_clock)
    table += "draw: by the CPU's clock until its calls return, where the driver has no timer to be believed.\n";
  return table;
}

}  // namespace vestige
