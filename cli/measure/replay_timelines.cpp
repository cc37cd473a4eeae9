#include "cli/measure/replay_timelines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <utility>

#include "cli/choices/person_value.hpp"
#include "traces/base/error.hpp"

namespace vestige::cli {

Timelines::Timelines(const ReplayOptions& options, OpenTrace& trace) : overwrite_(options.common.overwrite()) {
  if (options.timeline.empty()) return;
  const auto has_actuators = [](const TracedPerson& person) { return person.map.actuator_count > 0; };
  const auto count = std::ranges::count_if(trace.people, has_actuators);
  if (count == 0)
    throw UsageError(
        "--timeline", fmt::format("there is no actuator in {}, so nothing to write", options.trace),
        "give the trace an actuator map with 'vestige record --map', or here with --map, or leave --timeline out");
  if (count > 1 && is_pipe(options.timeline))
    throw UsageError("--timeline",
                     fmt::format("each of {} people has a timeline, and '{}' takes one", count, options.timeline),
                     "name a file: OUT.csv is the first person's, OUT.2.csv the second's");
  require_spheres(std::span(&options.law.law, 1), trace.reader.has_spheres(), options.trace);
  of_people_.resize(trace.people.size());
  bool is_first = true;
  for (std::size_t i = 0; i < trace.people.size(); ++i) {
    const TracedPerson& person = trace.people[i];
    if (!has_actuators(person)) {
      warn(fmt::format("{} has no actuator, and so no timeline", person.name), options.common.verbosity());
      continue;
    }
    const std::string path = std::exchange(is_first, false) ? options.timeline : numbered_path(options.timeline, i);
    of_people_[i].emplace(One{path, DriveMaker(options.law, person.avatar, person.map), person.map.names});
  }
}

void Timelines::add_paths_to(std::vector<std::string>& outputs) const {
  bool is_first = true;
  for (const auto& one : of_people_)
    if (one && !std::exchange(is_first, false)) outputs.push_back(one->path);
}

PlaneSet Timelines::planes() const {
  PlaneSet planes;
  for (const auto& one : of_people_)
    if (one) planes = planes | one->drives.planes();
  return planes;
}

void Timelines::open() {
  for (auto& one : of_people_) {
    if (!one) continue;
    one->file = make_timeline(one->path, overwrite_, one->actuator_names);
    one->drive = one->drives.make();
  }
}

void Timelines::commit() {
  for (auto& one : of_people_)
    if (one) one->file->commit();
}

const Timelines::One* Timelines::find(std::size_t person) const {
  return person < of_people_.size() && of_people_[person] ? &*of_people_[person] : nullptr;
}

}  // namespace vestige::cli
