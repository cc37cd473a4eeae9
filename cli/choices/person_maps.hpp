#pragma once

#include <CLI/CLI.hpp>
#include <span>
#include <string>
#include <vector>

#include "cli/choices/person_value.hpp"
#include "cli/choices/scene.hpp"

namespace vestige::cli {

inline constexpr PersonFlag kMapFlag = {"--map", "map", "FILE.png"};

/// Adds --map of a verb that replays traces.
CLI::Option* add_maps_option(CLI::App& verb, std::vector<std::string>& maps, const std::string& group);

/// Reads the values of --map, or of a flag like it. Throws `UsageError` as `parse_person_values`.
std::vector<PersonValue> parse_maps(const std::vector<std::string>& texts, const PersonFlag& flag = kMapFlag);

/// Adds the files that the maps may come from to the files that a verb reads.
void add_map_files(const std::vector<PersonValue>& maps, std::vector<std::string>& inputs);

/// Reads a map for a person, and warns of what is odd about it. `trace` is the trace's name. "none" gives a map without
/// actuators.
ActuatorMap read_map(const std::string& map, const TracedPerson& person, const std::string& trace, Verbosity verbosity);

/// Returns what is odd about a map that a person has.
std::vector<std::string> map_warnings(const ActuatorMap& map, const TracedPerson& person, const SceneNames& names);

/// Gives the people of a trace the maps of `flag`. Throws `UsageError` as `person_of`.
void use_maps(const std::vector<PersonValue>& maps, std::span<TracedPerson> people, const std::string& trace,
              Verbosity verbosity, const PersonFlag& flag = kMapFlag);

}  // namespace vestige::cli
