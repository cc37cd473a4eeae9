#include "analysis/batch/trace_groups.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "analysis/base/stratified_bootstrap.hpp"
#include "traces/base/number_text.hpp"

namespace vestige {

namespace {

constexpr const char* kFiles = "files";
constexpr const char* kMoreSeeds = "(--seeds 1:20 records more)";

/// The traces of a batch, counted.
struct TraceCount {
  std::size_t files = 0;
  std::vector<std::size_t> seeds;  ///< of each scenario
  std::string scenario_of_few;     ///< the scenario with the fewest seeds
};

TraceCount count_traces(const TraceGroups& groups) {
  TraceCount count;
  for (std::size_t g = 0; g < groups.names.size(); ++g) {
    const auto traces = static_cast<std::size_t>(std::ranges::count(groups.of_trace, g));
    if (groups.names[g] == kFiles) {
      count.files = traces;
      continue;
    }
    if (count.seeds.empty() || traces < std::ranges::min(count.seeds)) count.scenario_of_few = groups.names[g];
    count.seeds.push_back(traces);
  }
  return count;
}

std::string describe(const TraceCount& count) {
  std::vector<std::string> parts;
  if (!count.seeds.empty()) {
    const auto [least, most] = std::ranges::minmax(count.seeds);
    std::string seeds;
    if (most > 1)
      seeds = least == most ? fmt::format(" x {} seeds", most) : fmt::format(" x {} to {} seeds", least, most);
    parts.push_back(counted(count.seeds.size(), "scenario") + seeds);
  }
  if (count.files != 0) parts.push_back(counted(count.files, "file"));
  return fmt::format("{}", fmt::join(parts, " and "));
}

std::string why_no_intervals(const TraceCount& count) {
  if (count.files != 0 && count.files <= StratifiedBootstrap::kLeastFreedom)
    return fmt::format("there {} {} and intervals need {} files", count.files == 1 ? "is only" : "are only",
                       counted(count.files, "file"), StratifiedBootstrap::kLeastFreedom + 1);
  if (!count.seeds.empty() && std::ranges::max(count.seeds) == 1)
    return fmt::format("each scenario was recorded with one seed {}", kMoreSeeds);
  const std::size_t traces = std::accumulate(count.seeds.begin(), count.seeds.end(), count.files);
  const std::size_t groups = count.seeds.size() + (count.files == 0 ? 0 : 1);
  if (traces < groups + StratifiedBootstrap::kLeastFreedom)
    return fmt::format("{} are too few {}", describe(count), kMoreSeeds);
  if (!count.seeds.empty() && std::ranges::min(count.seeds) < StratifiedBootstrap::kLeastUnits)
    return fmt::format("{} has {} and intervals need {} of each scenario {}", count.scenario_of_few,
                       counted(std::ranges::min(count.seeds), "seed"), StratifiedBootstrap::kLeastUnits, kMoreSeeds);
  return "";
}

}  // namespace

TraceGroups group_traces(const nlohmann::ordered_json& batch, std::span<const std::string> names) {
  std::map<std::string, std::string> group_of;                    // by the trace's name
  for (const nlohmann::ordered_json& trace : batch.at("traces"))  // a batch of an earlier version has no seeds
    group_of[trace.at("name").get<std::string>()] =
        trace.contains("seed") ? trace.at("given").get<std::string>() : kFiles;
  TraceGroups groups;
  groups.of_trace.reserve(names.size());
  for (const std::string& trace : names) {
    const std::string& name = group_of[trace];
    const auto found = std::ranges::find(groups.names, name);
    groups.of_trace.push_back(static_cast<std::size_t>(found - groups.names.begin()));
    if (found == groups.names.end()) groups.names.push_back(name);
  }
  const TraceCount count = count_traces(groups);
  groups.over = describe(count);
  groups.why_no_intervals = why_no_intervals(count);
  groups.strata = groups.of_trace;
  if (!groups.why_no_intervals.empty()) std::iota(groups.strata.begin(), groups.strata.end(), 0);
  return groups;
}

}  // namespace vestige
