#include "cli/measure/view_sides.hpp"

#include <fmt/format.h>

#include <memory>
#include <span>

#include "analysis/run/detection_run.hpp"
#include "cli/options.hpp"
#include "traces/base/error.hpp"
#include "traces/base/number_text.hpp"

namespace vestige::cli {

namespace {

void require_two(const std::vector<std::string>& values, const std::string& flag, const std::string& example) {
  if (values.size() != 2)
    throw UsageError(flag, fmt::format("names {}, but a page has two sides", counted(values.size(), "value")),
                     "write " + example);
  if (values[0] == values[1]) throw UsageError(flag, "both sides would be the same", "write " + example);
}

std::vector<std::optional<DriveMaker>> make_drives(const std::vector<TracedPerson>& people, OpenTrace& trace,
                                                   const ViewOptions& options) {
  std::vector<std::optional<DriveMaker>> drives(people.size());
  bool any = false;
  for (std::size_t i = 0; i < drives.size(); ++i) {
    if (people[i].map.actuator_count == 0) continue;
    any = true;
    drives[i].emplace(options.law, people[i].avatar, people[i].map);
  }
  if (any) require_spheres(std::span(&options.law.law, 1), trace.reader.has_spheres(), options.trace);
  return drives;
}

PlaneSet planes_of(const std::vector<std::optional<DriveMaker>>& drives) {
  PlaneSet planes = kHashedPlanes | Plane::kBarycentric | Plane::kPosition | Plane::kSide;
  for (const auto& drive : drives)
    if (drive) planes = planes | drive->planes();
  return planes;
}

/// A side on its way through the trace.
struct RunningSide {
  RunningSide(const ViewSide& side, std::span<const std::uint32_t> collider_ids) : drives(side.people.size()) {
    std::vector<DetectedPerson> people;
    for (std::size_t i = 0; i < side.people.size(); ++i) {
      people.push_back({i, side.people[i].avatar, *side.detectors[i]});
      if (side.drives[i]) drives[i] = side.drives[i]->make();
    }
    run.emplace(people, collider_ids);
  }

  std::optional<DetectionRun> run;
  std::vector<std::unique_ptr<ActuatorDrive>> drives;
};

}  // namespace

std::vector<SideChoice> side_choices(const ViewOptions& options) {
  const std::vector<PersonValue> maps = parse_maps(options.map);
  if (!options.detectors.empty()) {
    const std::vector<std::string> names = parse_names(options.detectors, detector_names(), "--detectors");
    require_two(names, "--detectors", "--detectors paper,cpu");
    std::vector<SideChoice> choices;
    for (const std::string& name : names) choices.push_back({name, name, maps});
    return choices;
  }
  if (options.maps.empty()) return {{"", options.choice.detector, maps}};
  require_two(options.maps, "--maps", "--maps paper6 torso40");
  std::vector<SideChoice> choices;
  for (const std::string& map : options.maps) choices.push_back({map, options.choice.detector, parse_maps({map})});
  return choices;
}

std::vector<ViewSide> make_sides(const std::vector<SideChoice>& choices, OpenTrace& trace, const ViewOptions& options) {
  std::vector<ViewSide> sides;
  for (const SideChoice& choice : choices) {
    ViewSide side = {choice.title, trace.people, {}, {}};
    use_maps(choice.maps, side.people, options.trace, options.common.verbosity());
    side.drives = make_drives(side.people, trace, options);
    sides.push_back(std::move(side));
    // Detectors may keep references to the people, who now stay where they are.
    ViewSide& made = sides.back();
    made.detectors = make_detectors(choice.detector, options.choice, made.people, planes_of(made.drives));
  }
  return sides;
}

std::vector<PagePerson> page_people(const std::vector<ViewSide>& sides) {
  std::vector<PagePerson> people;
  for (std::size_t side = 0; side < sides.size(); ++side)
    for (std::size_t body = 0; body < sides[side].people.size(); ++body) {
      const TracedPerson& person = sides[side].people[body];
      people.push_back({person.name, person.avatar, person.map, body, side});
    }
  return people;
}

std::vector<std::string> side_titles(const std::vector<ViewSide>& sides) {
  std::vector<std::string> titles;
  if (sides.size() > 1)
    for (const ViewSide& side : sides) titles.push_back(side.title);
  return titles;
}

Findings pack_frames(OpenTrace& trace, const std::vector<ViewSide>& sides, PagePacker& packer,
                     const ViewOptions& options) {
  const std::vector<std::uint32_t> ids = trace.reader.collider_ids();
  std::vector<RunningSide> running;
  for (const ViewSide& side : sides) running.emplace_back(side, ids);
  Findings found = {std::vector<std::uint64_t>(sides.size()), {}};
  const auto total = static_cast<double>(trace.reader.frame_count());
  double done = 0;
  Progress progress("Looking for contacts", options.common.verbosity());
  TraceFrame frame;
  while (trace.reader.next(frame)) {
    packer.add(frame);
    std::size_t person = 0;
    for (std::size_t side = 0; side < sides.size(); ++side) {
      DetectionRun& run = *running[side].run;
      run.step(frame);
      for (std::size_t i = 0; i < running[side].drives.size(); ++i, ++person) {
        found.contacts[side] += packer.add_contacts(person, run.frame(i), run.row(i));
        ActuatorDrive* const drive = running[side].drives[i].get();
        if (drive != nullptr) packer.add_duties(person, drive->next(frame.time_s(), run.row(i), &run.frame(i)));
      }
    }
    if (!progress.update(++done / total)) throw Error(options.trace, "writing the page was stopped", "");
  }
  // All sides get the same frames.
  for (std::size_t i = 0; i < trace.people.size(); ++i) {
    const FrameBuilder& built = running.front().run->builder(i);
    const std::string note =
        describe_non_finite(built.non_finite_frames(), built.non_finite_segments(), built.first_non_finite());
    const std::string who = trace.people.size() > 1 ? fmt::format("{}: ", trace.people[i].name) : "";
    if (!note.empty()) found.notes.push_back(who + note);
  }
  return found;
}

}  // namespace vestige::cli
