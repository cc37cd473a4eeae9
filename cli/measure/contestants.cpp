#include "cli/measure/contestants.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <utility>

#include "cli/options.hpp"
#include "detector/detectors/embree_detector.hpp"
#include "detector/detectors/make_detectors.hpp"
#include "traces/base/error.hpp"

namespace vestige::cli {

namespace {

/// The planes that shaders draw: all but the pressure, which the CPU computes.
constexpr std::uint32_t kMostPlanes = 8;

/// The detectors that are measured: exact is too slow.
std::vector<std::string> contestant_names() {
  std::vector<std::string> names = detector_names();
  std::erase(names, "exact");
  return names;
}

/// The planes to measure a detector with: only `paper` renders each into a target of its own.
std::vector<PlaneSet> planes_of(const std::string& detector, const ContestantChoice& choice) {
  if (detector != "paper") return {PlaneSet()};
  std::vector<PlaneSet> planes;
  for (const std::uint32_t count : parse_counts(choice.planes, "--planes")) planes.push_back(PlaneSet::first(count));
  return planes;
}

bool is_embree(const std::string& detector) {
  return detector == "embree" || detector == "embree_default";
}

}  // namespace

void add_contestant_options(CLI::App& verb, ContestantChoice& choice) {
  verb.add_option("--detector", choice.detectors, describe_detectors("measure", contestant_names()))
      ->capture_default_str()
      ->group(kDetectorGroup)
      ->type_name("LIST");
  verb.add_option("--context", choice.contexts,
                  "OpenGL contexts to measure paper, geometry and compute in: egl, osmesa, auto")
      ->capture_default_str()
      ->group(kDetectorGroup)
      ->type_name("LIST");
  add_detector_options(verb, choice.choice, choice.skips);
}

void check_contestant_choice(const ContestantChoice& choice) {
  const std::vector<std::string> detectors = parse_names(choice.detectors, contestant_names(), "--detector");
  if (parse_names(choice.contexts, {"egl", "osmesa", "auto"}, "--context").size() > 1 &&
      choice.contexts.find("auto") != std::string::npos)
    throw UsageError("--context", "'auto' already means egl or osmesa", "name egl and osmesa, or auto alone");
  parse_names(choice.skips, kSkipNames, "--skip");
  if (choice.planes != "1" && std::ranges::find(detectors, "paper") == detectors.end())
    throw UsageError("--planes",
                     fmt::format("changes nothing for --detector {}: only paper draws planes", choice.detectors),
                     "add paper to --detector");
  if (const std::uint32_t most = std::ranges::max(parse_counts(choice.planes, "--planes")); most > kMostPlanes)
    throw UsageError("--planes", fmt::format("asks for {} planes, but there are {}", most, kMostPlanes),
                     "ask for 1 to 8 planes");
}

ContestantMaker survey_maker(const ContestantChoice& choice) {
  DetectorChoice survey = choice.choice;
  survey.skip = "on";
  return [survey](const Avatar& avatar, const ActuatorMap& map, PlaneSet planes) {
    return make_detector("cpu", "", survey, avatar, map, planes);
  };
}

std::vector<Contestant> make_contestants(const ContestantChoice& choice, Verbosity verbosity) {
  std::vector<Contestant> contestants;
  const auto add = [&](const std::string& detector, const std::string& context) {
    const std::vector<std::string> skips =
        knows_skip(detector) ? parse_list(choice.skips) : std::vector<std::string>{"off"};
    for (const std::string& skip : skips) {
      DetectorChoice one = choice.choice;
      one.skip = skip;
      for (const PlaneSet planes : planes_of(detector, choice)) {
        // One context serves all people of a crowd.
        const auto shared = std::make_shared<SharedContext>(context, one.device);
        contestants.push_back({detector, one.skip_kind(), planes,
                               [one, detector, shared](const Avatar& avatar, const ActuatorMap& map, PlaneSet set) {
                                 return make_detector(detector, *shared, one, avatar, map, set);
                               }});
        if (choice.renderer == "off") continue;
        Contestant beside_renderer = contestants.back();
        beside_renderer.make_renderer_context = [one, context] {
          return make_gl_context(context_kind(context), one.device);
        };
        contestants.push_back(std::move(beside_renderer));
      }
    }
  };
  for (const std::string& detector : parse_list(choice.detectors)) {
    for (const std::string& context :
         needs_opengl(detector) ? parse_list(choice.contexts) : std::vector<std::string>{""}) {
      try {
        if (needs_opengl(detector)) {
          const auto gl = make_gl_context(context_kind(context), choice.choice.device);
          if (detector != "paper") require_proofs(detector, gl->info());
        }
        if (is_embree(detector)) require_embree();
      } catch (const Error& error) {
        if (choice.choice.device >= 0 && needs_opengl(detector)) throw;  // who names a device means no other
        warn(fmt::format("no series '{}'{}: {}", detector, context.empty() ? "" : " on " + context, error.what()),
             verbosity);
        continue;
      }
      add(detector, context);
    }
  }
  if (contestants.empty())
    throw Error("--context", "none of the requested detectors can run on this machine",
                "use --detector cpu, which needs no OpenGL; 'vestige devices' lists the contexts of this machine");
  return contestants;
}

}  // namespace vestige::cli
