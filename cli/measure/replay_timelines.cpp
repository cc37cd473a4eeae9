#include "cli/measure/replay_timelines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <span>

#include "traces/base/error.hpp"

namespace vestige::cli {

namespace {

/// Returns the path of a person's timeline.
std::string numbered_path(const std::string& path, std::size_t person) {
  if (person == 0) return path;
  const std::filesystem::path given(path);
  const std::string name = fmt::format("{}.{}{}", given.stem().string(), person + 1, given.extension().string());
  return std::filesystem::path(given).replace_filename(name).string();
}

bool is_pipe(const std::string& path) {
  std::error_code missing;
  return path == "-" || (std::filesystem::exists(path, missing) && !std::filesystem::is_regular_file(path, missing));
}

}  // namespace

Timelines::Timelines(const ReplayOptions& options, OpenTrace& trace) : overwrite_(options.common.overwrite()) {
  if (options.timeline.empty()) return;
  const auto has_actuators = [](const TracedPerson& person) { return person.map.actuator_count > 0; };
  const auto count = std::ranges::count_if(trace.people, has_actuators);
  if (count == 0)
    throw UsageError("--timeline", fmt::format("there is no actuator in {}, so nothing to write", options.trace),
                     "give the trace an actuator map with 'vestige record --map', or leave --timeline out");
  if (trace.people.size() > 1 && is_pipe(options.timeline))
    throw UsageError(
        "--timeline",
        fmt::format("each of {} people has a timeline, and '{}' takes one", trace.people.size(), options.timeline),
        "name a file: OUT.csv is the first person's, OUT.2.csv the second's");
  require_spheres(std::span(&options.law.law, 1), trace.reader.has_spheres(), options.trace);
  for (std::size_t i = 0; i < trace.people.size(); ++i) {
    const TracedPerson& person = trace.people[i];
    auto& one = of_people_.emplace_back();
    const std::string path = numbered_path(options.timeline, i);
    if (has_actuators(person))
      one.emplace(One{path, DriveMaker(options.law, person.avatar, person.map), person.map.names});
    else
      warn(fmt::format("{}: is not written, as {} has no actuator", path, person.name), options.common.verbosity());
  }
}

void Timelines::add_paths_to(std::vector<std::string>& outputs) const {
  for (std::size_t i = 1; i < of_people_.size(); ++i)
    if (of_people_[i]) outputs.push_back(of_people_[i]->path);
}

PlaneSet Timelines::planes() const {
  PlaneSet planes;
  for (const auto& one : of_people_)
    if (one) planes = planes | one->drives.planes();
  return planes;
}

nlohmann::ordered_json Timelines::law() const {
  for (const auto& one : of_people_)
    if (one) return one->drives.to_json();
  return {};
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

const DriveMaker* Timelines::drives_of(std::size_t person) const {
  const One* one = find(person);
  return one == nullptr ? nullptr : &one->drives;
}

TimelineFile* Timelines::file_of(std::size_t person) const {
  const One* one = find(person);
  return one == nullptr ? nullptr : one->file.get();
}

ActuatorDrive* Timelines::drive_of(std::size_t person) const {
  const One* one = find(person);
  return one == nullptr ? nullptr : one->drive.get();
}

std::string Timelines::path_of(std::size_t person) const {
  const One* one = find(person);
  return one == nullptr ? "" : one->path;
}

}  // namespace vestige::cli
