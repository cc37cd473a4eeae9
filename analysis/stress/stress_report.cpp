#include "analysis/stress/stress_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <vector>

#include "analysis/base/statistics.hpp"
#include "traces/base/number_text.hpp"

namespace vestige {

namespace {

std::string column_of(const StressCount& count) {
  return count.method == Method::kStatic ? count.detector : fmt::format("{} {}", count.detector, name_of(count.method));
}

std::string name_of(const StressFamily& family) {
  return family.variant.empty() ? std::string(family.name) : fmt::format("{} ({})", family.name, family.variant);
}

std::string cell_of(const StressCount& count) {
  if (count.felt() == 0 && count.wrong_winner == 0) return "0";
  return fmt::format("{}/{}/{}/{}", count.false_negatives, count.false_positives,
                     count.wrong_triangle + count.wrong_actuator, count.wrong_winner - count.wrong_triangle);
}

double share_of(const StressCount& count) {
  return static_cast<double>(count.felt()) / static_cast<double>(count.cases);
}

/// Returns a line for each column: where it errs most, and how sure that is.
std::string worst_lines(std::span<const StressCount> counts, const std::vector<std::string>& columns) {
  std::string lines =
      "\nWhere each errs most, as a share of the cases (missed, false, other triangle or actuator; 95 % Wilson "
      "intervals):\n";
  for (const std::string& column : columns) {
    const StressCount* worst = nullptr;
    for (const StressCount& count : counts)
      if (column_of(count) == column && (worst == nullptr || share_of(count) > share_of(*worst))) worst = &count;
    const Interval interval = wilson_interval(worst->felt(), worst->cases);
    const auto alike = std::ranges::count_if(counts, [&](const StressCount& count) {
      return column_of(count) == column && share_of(count) == share_of(*worst);
    });
    std::string found = fmt::format("nowhere: less than {} % in each family", percent_text(interval.high));
    if (worst->felt() != 0)
      found = fmt::format(
          "{} {:g}{}: {} % ({} to {} %)", name_of(worst->family), worst->magnitude,
          alike == 1 ? "" : fmt::format(" (and {} alike)", counted(static_cast<std::uint64_t>(alike - 1), "more row")),
          percent_text(share_of(*worst)), percent_text(interval.low), percent_text(interval.high));
    fmt::format_to(std::back_inserter(lines), "  {:<24} {}\n", column, found);
  }
  return lines;
}

bool same_row(const StressCount& a, const StressCount& b) {
  return a.family.name == b.family.name && a.family.variant == b.family.variant && a.magnitude == b.magnitude;
}

}  // namespace

nlohmann::ordered_json to_json(std::span<const StressCount> counts) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const StressCount& count : counts)
    list.push_back({{"name", count.family.name},
                    {"variant", count.family.variant},
                    {"magnitude", count.magnitude},
                    {"detector", count.detector},
                    {"method", vestige::name_of(count.method)},
                    {"cases", count.cases},
                    {"contacts", count.contacts},
                    {"false_negatives", count.false_negatives},
                    {"false_positives", count.false_positives},
                    {"wrong_winner", count.wrong_winner},
                    {"wrong_triangle", count.wrong_triangle},
                    {"wrong_actuator", count.wrong_actuator},
                    {"unsure", count.unsure},
                    {"felt_share", share_of(count)},
                    {"felt_share_low", wilson_interval(count.felt(), count.cases).low},
                    {"felt_share_high", wilson_interval(count.felt(), count.cases).high}});
  return list;
}

std::string stress_table(std::span<const StressCount> counts) {
  std::vector<std::string> columns;
  for (const StressCount& count : counts)
    if (std::ranges::find(columns, column_of(count)) == columns.end()) columns.push_back(column_of(count));
  std::string table = fmt::format("{:<29} {:>9} {:>8}", "family", "magnitude", "cases");
  for (const std::string& column : columns) fmt::format_to(std::back_inserter(table), "  {:>16}", column);
  table += '\n';
  for (auto row = counts.begin(); row != counts.end();) {
    const auto end = std::find_if(row, counts.end(), [&](const StressCount& count) { return !same_row(count, *row); });
    fmt::format_to(std::back_inserter(table), "{:<29} {:>9g} {:>8}", name_of(row->family), row->magnitude, row->cases);
    for (const std::string& column : columns) {
      const auto cell = std::find_if(row, end, [&](const StressCount& count) { return column_of(count) == column; });
      fmt::format_to(std::back_inserter(table), "  {:>16}", cell == end ? "-" : cell_of(*cell));
    }
    table += '\n';
    row = end;
  }
  return table + "Missed / false / on another triangle or actuator / with other bits of t; 0: no errors.\n" +
         worst_lines(counts, columns);
}

std::string family_definitions() {
  std::string text;
  std::string_view before;
  for (const StressFamily& family : stress_families()) {
    if (family.name == before && family.variant.find("raw") == std::string_view::npos) continue;
    before = family.name;
    fmt::format_to(std::back_inserter(text), "{}: {} Magnitude: {}.\n", name_of(family), family.meaning,
                   family.magnitude);
  }
  return text;
}

}  // namespace vestige
