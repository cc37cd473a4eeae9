#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "analysis/run/seen_run.hpp"
#include "cli/choices/detectors.hpp"
#include "cli/choices/scene.hpp"
#include "detector/actuators/law_maker.hpp"

namespace vestige::cli {

/// Returns the people with their maps, which it refers to.
std::vector<MappedPerson> mapped(std::span<const TracedPerson> people);

/// Makes the run of these people through a trace, whose name is `file`. `planes` as in `SeenRun`. Throws `UsageError`
/// or `Error` if detector or law do not suit them.
SeenRun make_run(std::span<const TracedPerson> people, const DetectorChoice& choice, const LawFlags& law,
                 PlaneSet planes, OpenTrace& trace, const std::string& file);

/// Adds to a report how contacts are found and, if anybody has an actuator, felt: `method`, `surface` and `law`.
void add_choices(nlohmann::ordered_json& report, const DetectorChoice& choice, const SeenRun& run);

/// Returns sentences about what was not finite, at most one about each person.
std::vector<std::string> notes_of(const SeenRun& run, const OpenTrace& trace);

}  // namespace vestige::cli
