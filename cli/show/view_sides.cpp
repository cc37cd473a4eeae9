#include "cli/show/view_sides.hpp"

#include <fmt/format.h>

#include <utility>

#include "analysis/view/trace_page.hpp"
#include "traces/base/error.hpp"
#include "traces/base/number_text.hpp"

namespace vestige::cli {

namespace {

constexpr PersonFlag kMapsFlag = {"--maps", "map", "FILE.png"};

void require_two(const std::vector<std::string>& values, const std::string& flag, const std::string& example) {
  if (values.size() != 2)
    throw UsageError(flag, fmt::format("names {}, but a page has two sides", counted(values.size(), "value")),
                     "write " + example);
}

bool are_same(const PersonValue& a, const PersonValue& b) {
  return a.person.value_or(0) == b.person.value_or(0) && a.value == b.value;
}

std::vector<SideChoice> sides_of_detectors(const ViewOptions& options) {
  const std::vector<std::string> names =
      parse_names(fmt::format("{}", fmt::join(options.detectors, ",")), detector_names(), "--detectors");
  require_two(names, "--detectors", "--detectors paper,cpu");
  std::vector<SideChoice> choices;
  choices.reserve(names.size());
  for (const std::string& name : names) choices.push_back({name, name, parse_maps(options.map)});
  return choices;
}

std::vector<SideChoice> sides_of_maps(const ViewOptions& options) {
  const std::string example = "--maps paper6 torso40";
  require_two(options.maps, "--maps", example);
  std::vector<SideChoice> choices;
  choices.reserve(options.maps.size());
  for (const std::string& map : options.maps)
    choices.push_back({map, options.choice.detector, parse_maps({map}, kMapsFlag)});
  if (are_same(choices[0].maps.front(), choices[1].maps.front()))
    throw UsageError("--maps", "both sides would be the same", "write " + example);
  return choices;
}

}  // namespace

std::vector<SideChoice> side_choices(const ViewOptions& options) {
  if (!options.detectors.empty()) return sides_of_detectors(options);
  if (!options.maps.empty()) return sides_of_maps(options);
  return {{"", options.choice.detector, parse_maps(options.map)}};
}

std::vector<ViewSide> make_sides(const std::vector<SideChoice>& choices, OpenTrace& trace, const ViewOptions& options) {
  std::vector<ViewSide> sides;
  for (const SideChoice& choice : choices) {
    // "1=" tells nothing about a trace of one person.
    const std::string& title = options.maps.empty() || trace.people.size() > 1 ? choice.title : choice.maps[0].value;
    ViewSide& side = sides.emplace_back(ViewSide{title, trace.people, nullptr});
    use_maps(choice.maps, side.people, options.trace, options.common.verbosity(),
             options.maps.empty() ? kMapFlag : kMapsFlag);
    DetectorChoice detector = options.choice;
    detector.detector = choice.detector;
    side.run =
        std::make_unique<SeenRun>(make_run(side.people, detector, options.law, kPagePlanes, trace, options.trace));
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

std::vector<std::uint64_t> pack_frames(OpenTrace& trace, const std::vector<ViewSide>& sides, PagePacker& packer,
                                       const ViewOptions& options) {
  std::vector<SeenRun*> runs;
  runs.reserve(sides.size());
  for (const ViewSide& side : sides) runs.push_back(side.run.get());
  Progress progress("Looking for contacts", options.common.verbosity());
  auto contacts = pack_trace(trace.reader, runs, packer, [&](double share) { return progress.update(share); });
  if (!contacts) throw Error(options.trace, kStopped, kStartAgain);
  return std::move(*contacts);
}

}  // namespace vestige::cli
