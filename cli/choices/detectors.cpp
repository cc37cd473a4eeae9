#include "cli/choices/detectors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "cli/help/validators.hpp"
#include "detector/actuators/mapped_skin.hpp"
#include "detector/approximate/approximate_detectors.hpp"
#include "detector/depth/depth_detector.hpp"
#include "detector/detectors/embree_detector.hpp"
#include "detector/detectors/make_detectors.hpp"
#include "traces/base/error.hpp"
#include "traces/base/number_text.hpp"

namespace vestige::cli {

namespace {

constexpr const char* kSkipHelp =
    "on: cpu, geometry, compute and decimated do not skin or test what bounds prove to miss (the result is the same); "
    "off: they skin the "
    "whole avatar and consider every pair of segment and triangle";

/// Returns why --keep would change nothing, or "".
std::string refusal_of_keep(const CLI::App& verb) {
  const CLI::Option* detectors = verb.get_option_no_throw("--detectors");  // of `view`, in the place of --detector
  if (detectors == nullptr || detectors->empty()) detectors = verb.get_option("--detector");
  const std::string names =
      detectors->empty() ? detectors->get_default_str() : fmt::format("{}", fmt::join(detectors->results(), ","));
  if (names.find("decimated") != std::string::npos) return "";
  return fmt::format("changes nothing for {} {}: only decimated keeps a share of the triangles", detectors->get_name(),
                     names);
}

void add_common_detector_options(CLI::App& verb, DetectorChoice& choice) {
  const auto add = [&](const char* name, auto& value, const char* description) {
    return verb.add_option(name, value, description)->group(kDetectorGroup);
  };
  add("--device", choice.device, kDeviceHelp)->check(help::whole_number(0, 1023))->type_name("K");
  add("--method", choice.method, kMethodHelp)->capture_default_str()->check(CLI::IsMember(kMethodNames));
  add("--keep", choice.keep, "Share of the avatar's triangles that decimated keeps")
      ->type_name("SHARE")
      ->capture_default_str()
      ->check(help::between(1e-6, 1))
      ->check([&verb](const std::string&) { return refusal_of_keep(verb); });
  add("--surface", choice.surface,
      "all: skin without an actuator hides the skin behind it; mapped: colliders pass through skin without an actuator")
      ->capture_default_str()
      ->check(CLI::IsMember({"all", "mapped"}));
}

}  // namespace

void add_detector_and_context(CLI::App& verb, DetectorChoice& choice) {
  std::vector<std::string> values = detector_names();
  values.insert(values.begin(), "auto");
  verb.add_option(
          "--detector", choice.detector,
          "paper: HAVE 2010's geometry shader, as published; geometry: exact contacts (a geometry shader proves "
          "misses, and the CPU decides the rest); compute: the same with a compute shader; cpu: exact contacts without "
          "OpenGL; exact: the same contacts by "
          "slow rational arithmetic, as a check; embree: Embree 3 with its robust flag, refitted each frame (its "
          "fastest configuration); embree_default: embree without the robust flag; auto: the cheapest exact detector. "
          "Approximate ones, with simpler shapes in place of the skin: boxes: a box around what each joint moves, as "
          "vests with bounding boxes have it; capsules: a capsule for each joint, as game engines have it; decimated: "
          "an avatar with fewer triangles (--keep)")
      ->group(kDetectorGroup)
      ->capture_default_str()
      ->check(CLI::IsMember(values));
  verb.add_option("--context", choice.context, kContextHelp)
      ->group(kDetectorGroup)
      ->capture_default_str()
      ->check(CLI::IsMember({"auto", "egl", "osmesa"}));
}

void add_detector_options(CLI::App& verb, DetectorChoice& choice) {
  add_common_detector_options(verb, choice);
  verb.add_option("--skip", choice.skip, kSkipHelp)
      ->group(kDetectorGroup)
      ->capture_default_str()
      ->check(CLI::IsMember(kSkipNames));
}

void add_detector_options(CLI::App& verb, DetectorChoice& choice, std::string& skips) {
  add_common_detector_options(verb, choice);
  verb.add_option("--skip", skips, std::string(kSkipHelp) + "; off,on: compare both")
      ->group(kDetectorGroup)
      ->capture_default_str()
      ->type_name("LIST");
}

bool knows_skip(const std::string& detector) {
  return detector == "cpu" || detector == "geometry" || detector == "compute" || detector == "decimated";
}

const std::vector<std::string>& detector_names() {
  static const std::vector<std::string> names = {"paper",  "geometry",       "compute", "cpu",      "exact",
                                                 "embree", "embree_default", "boxes",   "capsules", "decimated"};
  return names;
}

bool is_approximate(const std::string& detector) {
  return detector == "boxes" || detector == "capsules" || detector == "decimated";
}

bool needs_opengl(const std::string& detector) {
  return detector == "paper" || detector == "geometry" || detector == "compute";
}

bool takes_radii(const std::string& detector) {
  return detector == "cpu" || detector == "geometry" || detector == "compute" || detector == "exact" ||
         is_approximate(detector);
}

void warn_of_radii(const std::vector<std::string>& detectors, std::size_t spheres, std::size_t colliders,
                   const std::string& scene, Verbosity verbosity) {
  if (spheres == 0) return;
  for (const std::string& detector : detectors)
    if (!takes_radii(detector))
      warn(fmt::format("{}: {} of {} have a radius, but {} tests the paths of their centres; cpu, geometry, compute, "
                       "exact, boxes, capsules and decimated test spheres",
                       scene, spheres, counted(colliders, "collider"), detector),
           verbosity);
}

void warn_of_radii(const std::vector<std::string>& detectors, TraceReader& trace, const std::string& file,
                   Verbosity verbosity) {
  if (std::ranges::all_of(detectors, takes_radii)) return;  // reads no more of the trace than is needed
  warn_of_radii(detectors, trace.sphere_ids().size(), trace.collider_ids().size(), file, verbosity);
}

std::vector<std::string> skin_detector_names() {
  std::vector<std::string> names = detector_names();
  std::erase_if(names, is_approximate);
  return names;
}

bool is_detector(const std::string& name) {
  return std::ranges::find(detector_names(), name) != detector_names().end();
}

std::string describe_detectors(const char* verb, const std::vector<std::string>& names) {
  return fmt::format("Detectors to {}: {}; 'vestige replay --help' explains each", verb, fmt::join(names, ", "));
}

std::string describe_methods(const char* verb) {
  return fmt::format("Methods to {}, with each detector that knows them. {}", verb, kMethodHelp);
}

ContextKind context_kind(const std::string& context) {
  if (context == "egl") return ContextKind::kEgl;
  if (context == "osmesa") return ContextKind::kOsMesa;
  return ContextKind::kAuto;
}

namespace {

std::unique_ptr<Detector> make_on_whole_skin(const std::string& name, SharedContext& context,
                                             const DetectorChoice& choice, const Avatar& avatar, const ActuatorMap& map,
                                             PlaneSet planes) {
  const DetectorOptions options = {choice.surface_kind(), planes, choice.method_kind(), choice.skip_kind()};
  if (name == "exact") return make_exact_detector(avatar, map, options);
  if (name == "embree") return make_embree_detector(EmbreeMode::kRobust, avatar, map, options);
  if (name == "embree_default") return make_embree_detector(EmbreeMode::kDefault, avatar, map, options);
  if (name == "geometry") return make_geometry_detector(context.get(), avatar, map, options);
  if (name == "compute") return make_compute_detector(context.get(), avatar, map, options);
  if (name == "cpu" || name == "auto") return make_cpu_detector(avatar, map, options);
  if (name == "boxes") return make_boxes_detector(avatar, map, options);
  if (name == "capsules") return make_capsules_detector(avatar, map, options);
  if (name == "decimated") return make_decimated_detector(choice.keep, avatar, map, options);
  if (name != "paper") throw std::logic_error(fmt::format("nothing here makes the detector '{}'", name));
  if (options.method != Method::kStatic)
    throw UsageError("--method", fmt::format("the published method does not support '{}'", choice.method),
                     "choose the detector geometry, compute or cpu, or --method static");
  return make_paper_detector(context.get(), avatar, map, options);
}

}  // namespace

std::shared_ptr<GlContext> SharedContext::get() {
  if (made_ == nullptr) made_ = make_gl_context(kind_, device_);
  return made_;
}

std::unique_ptr<Detector> make_detector(const std::string& name, const std::string& context,
                                        const DetectorChoice& choice, const Avatar& avatar, const ActuatorMap& map,
                                        PlaneSet planes) {
  SharedContext unshared(context, choice.device);
  return make_detector(name, unshared, choice, avatar, map, planes);
}

std::unique_ptr<Detector> make_detector(const std::string& name, SharedContext& context, const DetectorChoice& choice,
                                        const Avatar& avatar, const ActuatorMap& map, PlaneSet planes) {
  const auto make = [&](const Avatar& skin, const ActuatorMap& skin_map) {
    return make_on_whole_skin(name, context, choice, skin, skin_map, planes);
  };
  // The slow truth takes no short cut.
  const bool on_whole_skin = choice.surface_kind() == Surface::kAll || name == "exact";
  auto detector = on_whole_skin ? make(avatar, map) : on_mapped_skin(avatar, map, make);
  return planes.has(Plane::kDepth) ? with_depth(std::move(detector), avatar) : std::move(detector);
}

std::vector<std::unique_ptr<Detector>> make_detectors(const std::string& name, const DetectorChoice& choice,
                                                      std::span<const TracedPerson> people, PlaneSet planes) {
  SharedContext context(choice.context, choice.device);
  std::vector<std::unique_ptr<Detector>> detectors;
  for (const TracedPerson& person : people)
    detectors.push_back(make_detector(name, context, choice, person.avatar, person.map, planes));
  return detectors;
}

}  // namespace vestige::cli
