#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "analysis/run/detection_run.hpp"
#include "cli/choices/person_value.hpp"
#include "cli/vest/vest_options.hpp"
#include "cli/vest/wearer.hpp"

namespace vestige::cli {

/// Returns whether a map is a file that may change while it is felt.
bool is_watched(const std::string& map);

/// Returns the stamps of the files of --map, before they are read; empty for maps that are not watched.
std::vector<std::string> stamps_of(const std::vector<PersonValue>& maps);

/// Throws `UsageError` for flags that do not go together. `maps` are those of --map.
void check_vest_flags(const VestOptions& options, const std::vector<PersonValue>& maps);

/// Reads the ports. Throws `UsageError` if two people would get the same one.
std::vector<PersonValue> parse_ports(const VestOptions& options);

/// Returns the vests of a scene with so many people, by person. `stamps` are those of `maps`.
std::vector<WornVest> vests_of(const VestOptions& options, const std::vector<PersonValue>& ports,
                               const std::vector<PersonValue>& maps, const std::vector<std::string>& stamps,
                               std::size_t people);

/// Those who feel a scene, each with a vest.
using Wearers = std::vector<std::unique_ptr<Wearer>>;

/// Makes the wearers of all vests. `people` are all of the scene.
Wearers make_wearers(const VestOptions& options, const std::vector<WornVest>& vests, std::vector<TracedPerson>& people,
                     const std::string& detector, SharedContext& context);

/// Returns the people whose contacts are to be found.
std::vector<DetectedPerson> detected_people(const Wearers& wearers);

/// Makes a law for each wearer.
std::vector<LawMaker::Law> make_laws(const Wearers& wearers);

/// Switches all vests off. Nobody waits for the answers of another's vest.
void finish(const Wearers& wearers);

/// Gives the files of all vests their names, after `finish`.
void commit(const Wearers& wearers);

}  // namespace vestige::cli
