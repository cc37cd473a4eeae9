#include "cli/measure/replay_maps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "analysis/mapping/layouts.hpp"
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

/// Reads a map for a person, and warns of what is odd about it. "none" gives a map without actuators.
ActuatorMap read_map(const std::string& map, const TracedPerson& person, const ReplayOptions& options) {
  const ActuatorMapFiles files = read_map_files(person.avatar, map);
  if (files.png.empty()) return {};
  ActuatorMap read = parse_actuator_map(files, person.avatar, map);
  for (const std::string& warning : read.warnings) warn(warning, options.common.verbosity());
  const std::string other = other_facing(person.avatar.facing, read.facing, {options.trace, map});
  if (!other.empty()) warn(other, options.common.verbosity());
  return read;
}

}  // namespace

std::vector<PersonMap> parse_maps(const ReplayOptions& options) {
  std::vector<PersonMap> maps;
  std::set<std::size_t> people;
  for (const std::string& text : options.maps) {
    PersonMap map;
    const std::size_t sign = std::min(text.find('='), text.size());
    const bool is_number = sign > 0 && sign < text.size() && text.find_first_not_of("0123456789") == sign;
    if (is_number) {
      std::size_t number = 0;
      const auto read = std::from_chars(text.data(), text.data() + sign, number);
      if (read.ec == std::errc() && number == 0)
        throw UsageError("--map", fmt::format("'{}': people count from 1", text), "write for example --map 2=FILE.png");
      map.person = read.ec == std::errc() ? number - 1 : std::numeric_limits<std::size_t>::max() - 1;  // nobody
    }
    map.file = is_number ? text.substr(sign + 1) : text;
    if (map.file == "-") throw UsageError("--map", "a map cannot come from standard input", "name a file or a layout");
    if (map.file.empty()) throw UsageError("--map", fmt::format("'{}' names no map", text), "name a file or a layout");
    if (!people.insert(map.person.value_or(0)).second)
      throw UsageError("--map", fmt::format("person {} gets two maps", map.person.value_or(0) + 1),
                       "leave one of them out");
    maps.push_back(map);
  }
  return maps;
}

void use_maps(const std::vector<PersonMap>& maps, OpenTrace& trace, const ReplayOptions& options) {
  for (const PersonMap& map : maps) {
    if (!map.person && trace.people.size() > 1)
      throw UsageError("--map", fmt::format("{} holds {} people", options.trace, trace.people.size()),
                       "say whose map it is: --map 1=FILE");
    const std::size_t person = map.person.value_or(0);
    if (person >= trace.people.size())
      throw UsageError("--map",
                       fmt::format("there is no person {} in {}, which holds {}", person + 1, options.trace,
                                   count_of_people(trace.people.size())),
                       "choose one who is there");
    trace.people[person].map = read_map(map.file, trace.people[person], options);
  }
}

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
    MapChange change = {timed.time_s, read_map(timed.file, person, options), nullptr};
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
