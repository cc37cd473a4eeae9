#pragma once

#include <string>
#include <vector>

#include "analysis/run/replay.hpp"
#include "cli/choices/scene.hpp"
#include "cli/measure/replay_options.hpp"

namespace vestige::cli {

/// One --map-at: when, and a map's file.
struct TimedMap {
  double time_s = 0;
  std::string file;
};

/// Reads the --map-at of a replay; returns them by time. Throws `UsageError` for what is no TIME=FILE, for a time that
/// stands twice, and for flags that cannot follow a change of the map.
std::vector<TimedMap> parse_map_at(const ReplayOptions& options);

/// Throws `UsageError` if maps would change in a trace of several people.
void check_people(const std::vector<TimedMap>& timed_maps, const OpenTrace& trace, const ReplayOptions& options);

/// Reads the maps that follow the person's own, warns of what is odd about them, and measures the layouts that the law
/// of `drives` needs; `drives` may be null. Throws `Error` for a map with another number of actuators than the
/// person's.
std::vector<MapChange> read_maps(const std::vector<TimedMap>& timed_maps, const TracedPerson& person,
                                 const DriveMaker* drives, const ReplayOptions& options);

}  // namespace vestige::cli
