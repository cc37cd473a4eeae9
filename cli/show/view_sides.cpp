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
  if (values[0] == values[1]) throw UsageError(flag, "both sides would be the same", "write " + example);
}

}  // namespace

std::vector<SideChoice> side_choices(const ViewOptions& options) {
  const std::vector<PersonValue> maps = parse_maps(options.map);
  if (!options.detectors.empty()) {
    const std::vector<std::string> names = parse_names(options.detectors, detector_names(), "--detectors");
    require_two(names, "--detectors", "--detectors paper,cpu");
    std::vector<SideChoice> choices;
    choices.reserve(names.size());
    for (const std::string& name : names) choices.push_back({name, name, maps});
    return choices;
  }
  if (options.maps.empty()) return {{"", options.choice.detector, maps}};
  require_two(options.maps, "--maps", "--maps paper6 torso40");
  std::vector<SideChoice> choices;
  for (const std::string& map : options.maps)
    choices.push_back({map, options.choice.detector, parse_maps({map}, kMapsFlag)});
  return choices;
}

std::vector<ViewSide> make_sides(const std::vector<SideChoice>& choices, OpenTrace& trace, const ViewOptions& options) {
  std::vector<ViewSide> sides;
  for (const SideChoice& choice : choices) {
    ViewSide& side = sides.emplace_back(ViewSide{choice.title, trace.people, nullptr});
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
