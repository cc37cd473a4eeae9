#include "analysis/frequency/growth_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>
#include <utility>

#include "analysis/frequency/sweep_report.hpp"

namespace vestige {

namespace {

/// The lines of one table, with the sizes along which they run.
struct CostTable {
  std::string_view along;
  std::vector<double> sizes;
  std::vector<CostLine> lines;
};

CostTable table_by_colliders(const Growth& growth) {
  CostTable table = {"colliders", {}, {}};
  for (const SweepSeries& series : growth.by_colliders) table.lines.push_back({name_of(series), mean_us(series)});
  if (!growth.by_colliders.empty())
    for (const SweepPoint& point : growth.by_colliders.front().points) table.sizes.push_back(point.colliders);
  return table;
}

CostTable table_by_triangles(const Growth& growth) {
  CostTable table = {"triangles", {}, {}};
  for (const GrowthSize& size : growth.by_triangles) {
    table.sizes.push_back(static_cast<double>(size.triangles));
    for (std::size_t i = 0; i < size.series.size(); ++i) {
      if (table.lines.size() <= i) table.lines.push_back({name_of(size.series[i]), {}});
      table.lines[i].us.push_back(mean_us(size.series[i]).front());
    }
  }
  return table;
}

std::string text_of(const CostTable& table) {
  std::string text = fmt::format("{:>9}", table.along);
  for (const CostLine& line : table.lines) fmt::format_to(std::back_inserter(text), "  {:>26}", line.name);
  text += "\n";
  for (std::size_t i = 0; i < table.sizes.size(); ++i) {
    fmt::format_to(std::back_inserter(text), "{:>9.0f}", table.sizes[i]);
    for (const CostLine& line : table.lines)
      fmt::format_to(std::back_inserter(text), "  {:>26}",
                     std::isnan(line.us[i]) ? "-" : fmt::format("{:.{}f} us", line.us[i], line.us[i] < 1000 ? 1 : 0));
    text += "\n";
  }
  for (const Crossover& crossover : crossovers(table.sizes, table.lines))
    fmt::format_to(std::back_inserter(text), "  at {:.3g} {}: below, '{}' is faster; above, '{}'\n", crossover.at,
                   table.along, crossover.cheaper_below, crossover.cheaper_above);
  return text;
}

std::string text_of(std::span<const Ablation> ablations) {
  if (ablations.empty()) return "";
  std::string text = fmt::format(
      "\nWhat skipping saves, means of a frame:\n{:>9}  {:<26}{:>10}{:>10}{:>16}{:>18}{:>12}{:>11}{:>12}{:>12}\n",
      "colliders", "", "skipped", "meshlets", "triangles", "pairs", "off", "on", "by frames", "by meshlets");
  for (const Ablation& one : ablations) {
    const auto each = [&](std::uint64_t count) { return static_cast<double>(count) / static_cast<double>(one.frames); };
    fmt::format_to(std::back_inserter(text),
                   "{:>9}  {:<26}{:>8.0f} %{:>10.1f}{:>16}{:>18}{:>9.1f} us{:>8.1f} us{:>9.1f} us{:>9.1f} us\n",
                   one.colliders, one.name, 100 * each(one.frames_skipped), each(one.meshlets_skinned),
                   fmt::format("{:.0f} of {:.0f}", each(one.triangles_tested), each(one.triangles)),
                   fmt::format("{:.0f} of {:.0f}", each(one.pairs_tested), each(one.pairs)), one.off_us, one.on_us,
                   one.saved_by_frames_us, one.saved_by_meshlets_us);
  }
  return text;
}

nlohmann::ordered_json to_json(const CostTable& table) {
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
  return {{"by_colliders", {{"series", to_json(growth.by_colliders, seed)}}},
          {"by_triangles", sizes},
          {"crossovers",
           {{"colliders", to_json(table_by_colliders(growth))}, {"triangles", to_json(table_by_triangles(growth))}}},
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
