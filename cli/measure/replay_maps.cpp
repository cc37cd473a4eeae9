#include "cli/measure/replay_maps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "cli/choices/person_maps.hpp"
#include "traces/base/error.hpp"
#include "traces/scene/people.hpp"

namespace vestige::cli {

namespace {

/// What --map-at cannot be used with.
void check_map_at(const ReplayOptions& options) {
  if (options.map_at.empty()) return;
  if (options.choice.surface == "mapped")
    throw UsageError("--map-at", "changes the mapped skin, and --surface mapped cannot follow",
                     "leave one of the two out");
  for (const std::string& detector : {options.choice.detector, options.verify})
    if (detector == "paper")
      throw UsageError("--map-at", "the detector 'paper' keeps its first map on the GPU", "choose another detector");
}

}  // namespace

std::vector<TimedMap> parse_map_at(const ReplayOptions& options) {
  check_map_at(options);
  std::vector<TimedMap> maps;
  for (const std::string& text : options.map_at) {
    const std::size_t sign = text.find('=');
    TimedMap timed;
    const char* const end = text.data() + std::min(sign, text.size());
    const auto [read_to, failure] = std::from_chars(text.data(), end, timed.time_s);
    if (sign == std::string::npos || failure != std::errc() || read_to != end || !std::isfinite(timed.time_s) ||
        sign + 1 == text.size())
      throw UsageError("--map-at", fmt::format("'{}' is not a time in seconds, an equals sign and a map", text),
                       "write for example --map-at 2.5=other.png");
    timed.file = text.substr(sign + 1);
    maps.push_back(timed);
  }
  std::ranges::stable_sort(maps, {}, &TimedMap::time_s);
  const auto twice = std::ranges::adjacent_find(maps, {}, &TimedMap::time_s);
  if (twice != maps.end())
    throw UsageError("--map-at", fmt::format("two maps begin at {} s", twice->time_s), "leave one of them out");
  return maps;
}

void check_people(const std::vector<TimedMap>& timed_maps, const OpenTrace& trace, const ReplayOptions& options) {
  if (timed_maps.empty() || trace.people.size() == 1) return;
  throw UsageError("--map-at",
                   fmt::format("changes the map of one person, and {} holds {}", options.trace,
                               count_of_people(trace.people.size())),
                   "use --map K=FILE, which holds from the start");
}

std::vector<MapChange> read_maps(const std::vector<TimedMap>& timed_maps, const TracedPerson& person,
                                 const DriveMaker* drives, const ReplayOptions& options) {
  std::vector<MapChange> changes;
  for (const TimedMap& timed : timed_maps) {
    if (timed.file == "none")
      throw UsageError("--map-at", "'none' is not a map", "name a PNG file, builtin or a layout");
    MapChange change = {timed.time_s, read_map(timed.file, person, options.trace, options.common.verbosity()), nullptr};
    if (change.map.actuator_count != person.map.actuator_count)
      throw Error(timed.file,
                  fmt::format("names {} actuators, and the map before it has {}", change.map.actuator_count,
                              person.map.actuator_count),
                  "use maps with the same number of actuators");
    if (drives != nullptr) change.layout = drives->layout_of(change.map);
    changes.push_back(std::move(change));
  }
  return changes;
}

}  // namespace vestige::cli
