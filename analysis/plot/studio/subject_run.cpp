#include "analysis/plot/studio/subject_run.hpp"

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "detector/depth/depth_detector.hpp"
#include "detector/detectors/make_detectors.hpp"

namespace vestige::plot {

namespace {

std::unique_ptr<Detector> make_detector(const Subject& person, PlaneSet planes, Method method) {
  DetectorOptions options;
  options.planes = planes;
  options.method = method;
  options.skip = Skip::kOn;
  std::unique_ptr<Detector> detector = make_cpu_detector(person.avatar, person.map, options);
  return planes.has(Plane::kDepth) ? with_depth(std::move(detector), person.avatar) : std::move(detector);
}

}  // namespace

SeenRun make_run(std::span<const Subject> people, std::span<const std::uint32_t> collider_ids, const LawFlags& law,
                 Method method, PlaneSet planes) {
  std::vector<MappedPerson> mapped;
  for (const Subject& person : people) mapped.push_back({person.avatar, person.map});
  return {{mapped, collider_ids, law, planes}, [&](PlaneSet all) {
            PeopleDetectors detectors;
            for (const Subject& person : people) detectors.push_back(make_detector(person, all, method));
            return detectors;
          }};
}

std::vector<std::string> notes_of(const SeenRun& run, std::size_t people) {
  std::vector<std::string> notes;
  for (std::size_t i = 0; i < people; ++i)
    if (const std::string note = run.non_finite(i); !note.empty())
      notes.push_back(people > 1 ? fmt::format("person {}: {}", i + 1, note) : note);
  return notes;
}

}  // namespace vestige::plot
