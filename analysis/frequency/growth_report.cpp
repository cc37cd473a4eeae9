#include "analysis/frequency/growth_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <optional>
#include <string_view>
#include <utility>

#include "analysis/frequency/sweep_report.hpp"

namespace vestige {

namespace {

/// The lines of one table, with the sizes along which they run.
struct CostTable {
  std::string_view along;
  double frame_limit_s;
  std::vector<double> sizes = {};
  std::vector<CostLine> lines = {};
  std::vector<std::vector<std::optional<std::uint64_t>>> memory_bytes = {};  ///< by line, then size

  void add_points(std::size_t line, const SweepSeries& series) {
    if (lines.size() <= line) {
      lines.push_back({name_of(series), {}});
      memory_bytes.emplace_back();
    }
    for (const SweepPoint& point : series.points) {
      lines[line].us.push_back(point.mean_us());
      memory_bytes[line].push_back(point.memory_bytes);
    }
  }
  std::vector<LeftOut> left_out() const { return vestige::left_out(sizes, lines, frame_limit_s); }
};

CostTable table_by_colliders(const Growth& growth) {
  CostTable table = {"colliders", growth.frame_limit_s};
  for (std::size_t i = 0; i < growth.by_colliders.size(); ++i) table.add_points(i, growth.by_colliders[i]);
  if (!growth.by_colliders.empty())
    for (const SweepPoint& point : growth.by_colliders.front().points) table.sizes.push_back(point.colliders);
  return table;
}

CostTable table_by_triangles(const Growth& growth) {
  CostTable table = {"triangles", growth.frame_limit_s};
  for (const GrowthSize& size : growth.by_triangles) {
    table.sizes.push_back(static_cast<double>(size.triangles));
    for (std::size_t i = 0; i < size.series.size(); ++i) table.add_points(i, size.series[i]);
  }
  return table;
}

/// Returns a table with one row for each size and one column for each line. `cell` is asked by line, then size.
std::string grid_of(const CostTable& table, const std::function<std::string(std::size_t, std::size_t)>& cell) {
  std::string text = fmt::format("{:>9}", table.along);
  for (const CostLine& line : table.lines) fmt::format_to(std::back_inserter(text), "  {:>26}", line.name);
  text += "\n";
  for (std::size_t i = 0; i < table.sizes.size(); ++i) {
    fmt::format_to(std::back_inserter(text), "{:>9.0f}", table.sizes[i]);
    for (std::size_t line = 0; line < table.lines.size(); ++line)
      fmt::format_to(std::back_inserter(text), "  {:>26}", cell(line, i));
    text += "\n";
  }
  return text;
}

std::string memory_grid(const CostTable& table) {
  return "Memory that each detector holds:\n" + grid_of(table, [&](std::size_t line, std::size_t size) {
           const std::optional<std::uint64_t> bytes = table.memory_bytes[line][size];
           if (!bytes) return std::string("-");
           const double megabytes = static_cast<double>(*bytes) / 1e6;
           return fmt::format("{:.{}f} MB", megabytes, megabytes < 10 ? 2 : 0);
         });
}

std::string text_of(const CostTable& table) {
  std::string text = grid_of(table, [&](std::size_t line, std::size_t size) {
    const double us = table.lines[line].us[size];
    return std::isnan(us) ? "-" : fmt::format("{:.{}f} us", us, us < 1000 ? 1 : 0);
  });
  const std::vector<LeftOut> left_out = table.left_out();
  if (!left_out.empty())
    fmt::format_to(std::back_inserter(text),
                   "  left out beyond a frame of {:g} s (--frame-limit):", table.frame_limit_s);
  for (const LeftOut& one : left_out)
    fmt::format_to(std::back_inserter(text), "{} '{}' above {:.0f} {} ({:.2g} s)", &one == left_out.data() ? "" : ",",
                   one.name, one.size, table.along, one.frame_s);
  if (!left_out.empty()) text += "\n";
  for (const Crossover& crossover : crossovers(table.sizes, table.lines))
    fmt::format_to(std::back_inserter(text), "  at {:.3g} {}: below, '{}' is faster; above, '{}'\n", crossover.at,
                   table.along, crossover.cheaper_below, crossover.cheaper_above);
  return text + memory_grid(table);
}

std::string text_of(std::span<const Ablation> ablations) {
  if (ablations.empty()) return "";
  std::string text = fmt::format(
      "\nWhat skipping saves, means of a frame:\n{:>9}  {:<26}{:>10}{:>10}{:>16}{:>24}{:>14}{:>13}{:>14}{:>14}\n",
      "colliders", "", "skipped", "meshlets", "triangles", "pairs", "off", "on", "by frames", "by meshlets");
  for (const Ablation& one : ablations) {
    const auto each = [&](std::uint64_t count) { return static_cast<double>(count) / static_cast<double>(one.frames); };
    fmt::format_to(std::back_inserter(text),
                   "{:>9}  {:<26}{:>8.0f} %{:>10.1f}{:>16}{:>24}{:>11.1f} us{:>10.1f} us{:>11.1f} us{:>11.1f} us\n",
                   one.colliders, one.name, 100 * each(one.frames_skipped), each(one.meshlets_skinned),
                   fmt::format("{:.0f} of {:.0f}", each(one.triangles_tested), each(one.triangles)),
                   fmt::format("{:.0f} of {:.0f}", each(one.pairs_tested), each(one.pairs)), one.off_us, one.on_us,
                   one.saved_by_frames_us, one.saved_by_meshlets_us);
  }
  return text;
}

nlohmann::ordered_json left_out_json(const CostTable& table) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const LeftOut& one : table.left_out())
    list.push_back({{"series", one.name}, {"above", one.size}, {"frame_s", one.frame_s}});
  return list;
}

nlohmann::ordered_json crossovers_json(const CostTable& table) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Crossover& crossover : crossovers(table.sizes, table.lines))
    list.push_back(
        {{"at", crossover.at}, {"cheaper_below", crossover.cheaper_below}, {"cheaper_above", crossover.cheaper_above}});
  return list;
}

nlohmann::ordered_json to_json(const Ablation& one, std::size_t triangles) {
  return {{"series", one.name},
          {"triangles_of_avatar", triangles},
          {"colliders", one.colliders},
          {"frames", one.frames},
          {"frames_skipped", one.frames_skipped},
          {"meshlets_skinned", one.meshlets_skinned},
          {"triangles", one.triangles},
          {"triangles_tested", one.triangles_tested},
          {"pairs", one.pairs},
          {"pairs_tested", one.pairs_tested},
          {"pairs_meeting", one.pairs_meeting},
          {"us_off", one.off_us},
          {"us_on", one.on_us},
          {"us_saved_by_frames", one.saved_by_frames_us},
          {"us_saved_by_meshlets", one.saved_by_meshlets_us}};
}

}  // namespace

nlohmann::ordered_json to_json(const Growth& growth, std::uint64_t seed) {
  nlohmann::ordered_json sizes = nlohmann::ordered_json::array();
  nlohmann::ordered_json ablation = nlohmann::ordered_json::array();
  if (!growth.by_triangles.empty())
    for (const Ablation& one : ablations(growth.by_colliders))
      ablation.push_back(to_json(one, growth.by_triangles.front().triangles));
  for (const GrowthSize& size : growth.by_triangles) {
    sizes.push_back({{"triangles", size.triangles},
                     {"vertices", size.vertices},
                     {"frames", size.frames},
                     {"series", to_json(size.series, seed)}});
    if (size.triangles != growth.by_triangles.front().triangles)
      for (const Ablation& one : ablations(size.series)) ablation.push_back(to_json(one, size.triangles));
  }
  const CostTable colliders = table_by_colliders(growth);
  const CostTable triangles = table_by_triangles(growth);
  return {{"frame_limit_s", growth.frame_limit_s},
          {"by_colliders", {{"series", to_json(growth.by_colliders, seed)}}},
          {"by_triangles", sizes},
          {"left_out", {{"colliders", left_out_json(colliders)}, {"triangles", left_out_json(triangles)}}},
          {"crossovers", {{"colliders", crossovers_json(colliders)}, {"triangles", crossovers_json(triangles)}}},
          {"ablation", ablation}};
}

std::string growth_table(const Growth& growth, std::uint32_t colliders) {
  std::string text = text_of(table_by_colliders(growth));
  if (!growth.by_triangles.empty())
    text += fmt::format("\nWith {} collider{}:\n", colliders, colliders == 1 ? "" : "s") +
            text_of(table_by_triangles(growth));
  const auto most_pairs = [&](std::size_t triangles, std::uint32_t count) { return std::uint64_t{triangles} * count; };
  const bool few_frames =
      std::ranges::any_of(growth.by_triangles,
                          [&](const GrowthSize& size) { return most_pairs(size.triangles, colliders) > kManyPairs; }) ||
      (!growth.by_triangles.empty() && !growth.by_colliders.empty() &&
       most_pairs(growth.by_triangles.front().triangles, growth.by_colliders.front().points.back().colliders) >
           kManyPairs);
  if (few_frames)
    text += fmt::format("Above {} pairs of collider and triangle: the mean of 3 frames, each measured repeatedly.\n",
                        kManyPairs);
  return text + text_of(ablations(growth.by_colliders));
}

}  // namespace vestige
