#include "cli/show/trace_run.hpp"

#include <algorithm>

namespace vestige::cli {

std::vector<MappedPerson> mapped(std::span<const TracedPerson> people) {
  std::vector<MappedPerson> mapped;
  for (const TracedPerson& person : people) mapped.push_back({person.avatar, person.map});
  return mapped;
}

SeenRun make_run(std::span<const TracedPerson> people, const DetectorChoice& choice, const LawFlags& law,
                 PlaneSet planes, OpenTrace& trace, const std::string& file) {
  const bool any_feels =
      std::ranges::any_of(people, [](const TracedPerson& person) { return person.map.actuator_count != 0; });
  if (any_feels) require_spheres(std::span(&law.law, 1), trace.reader.has_spheres(), file);
  return {{mapped(people), trace.reader.collider_ids(), law, planes},
          [&](PlaneSet all) { return make_detectors(choice.detector, choice, people, all); }};
}

void add_choices(nlohmann::ordered_json& report, const DetectorChoice& choice, const SeenRun& run) {
  report["method"] = choice.method;
  report["surface"] = choice.surface;
  if (run.any_feels()) report["law"] = run.law();
}

std::vector<std::string> notes_of(const SeenRun& run, const OpenTrace& trace) {
  std::vector<std::string> notes;
  for (std::size_t i = 0; i < trace.people.size(); ++i)
    if (const std::string note = run.non_finite(i); !note.empty()) notes.push_back(before_person(trace, i) + note);
  return notes;
}

}  // namespace vestige::cli
