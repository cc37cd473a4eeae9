#include "analysis/run/replay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <thread>
#include <utility>
#include <vector>

#include "analysis/base/provenance.hpp"
#include "analysis/run/seen_run.hpp"
#include "cli/choices/detectors.hpp"
#include "cli/choices/law_choice.hpp"
#include "cli/choices/person_maps.hpp"
#include "cli/choices/scene.hpp"
#include "cli/help/validators.hpp"
#include "cli/measure/replay_check.hpp"
#include "cli/measure/replay_maps.hpp"
#include "cli/measure/replay_options.hpp"
#include "cli/measure/replay_report.hpp"
#include "cli/measure/replay_timelines.hpp"
#include "cli/verbs.hpp"
#include "detector/detectors/path_choice.hpp"
#include "traces/base/error.hpp"
#include "traces/base/number_text.hpp"
#include "traces/questions/placement_question.hpp"

namespace vestige::cli {

namespace {

constexpr std::uint64_t kMostThreads = 256;
constexpr const char* kIntensityGroup = "Intensity";

struct NamedPlane {
  const char* name;
  Plane plane;
};
constexpr NamedPlane kPlaneNames[] = {
    {"actuator", Plane::kActuator},
    {"t", Plane::kTime},
    {"triangle", Plane::kTriangle},
    {"barycentric", Plane::kBarycentric},
    {"texture", Plane::kTextureCoordinate},
    {"position", Plane::kPosition},
    {"speed", Plane::kSpeed},
    {"side", Plane::kSide},
    {"pressure", Plane::kPressure},
    {"depth", Plane::kDepth},
};

/// Returns how many threads run if --threads is not given: one measures a frequency, and files are wanted soon.
/// Contexts of OpenGL share one GPU.
std::size_t default_threads(const ReplayOptions& options) {
  const bool writes = !options.contacts.empty() || !options.textures.empty() || !options.timeline.empty();
  if (!writes || needs_opengl(options.choice.detector) || needs_opengl(options.verify)) return 1;
  return std::clamp<std::size_t>(std::thread::hardware_concurrency(), 1, kMostThreads);
}

PlaneSet parse_planes(const std::string& text) {
  PlaneSet planes;
  std::string known;
  for (const NamedPlane& named : kPlaneNames) known += fmt::format(" {}", named.name);
  for (const std::string& part : parse_list(text)) {
    const NamedPlane* found = nullptr;
    for (const NamedPlane& named : kPlaneNames)
      if (part == named.name) found = &named;
    if (found == nullptr)
      throw UsageError("--planes", fmt::format("there is no plane '{}'", part), "choose from" + known);
    planes = planes | found->plane;
  }
  return planes;
}

/// Says why there may be fewer contacts than expected.
void warn_of_gaps(const ReplayResult& result, const OpenTrace& trace, const std::vector<TimedMap>& timed_maps,
                  const ReplayOptions& options) {
  const Verbosity verbosity = options.common.verbosity();
  if (result.interrupted) warn("stopped after " + counted(result.frames, "frame"), verbosity);
  for (std::size_t i = result.people.front().map_changes; i < timed_maps.size() && !result.interrupted; ++i)
    warn(fmt::format("--map-at {}={}: the trace ends before that time", timed_maps[i].time_s, timed_maps[i].file),
         verbosity);
  for (std::size_t i = 0; i < result.people.size(); ++i) {
    const PersonResult& person = result.people[i];
    const std::string note =
        describe_non_finite(person.non_finite_frames, person.non_finite_segments, person.first_non_finite);
    if (note.empty()) continue;
    warn(fmt::format("{}: {}{}", options.trace, before_person(trace, i), note), verbosity);
  }
}

/// Contacts that nobody feels are a reason to ask for another law or map.
void warn_of_silence(const PersonResult& result, const std::string& timeline, const ReplayOptions& options) {
  if (result.any_vibrates || result.contacts == 0) return;
  const bool by_place = law_named(options.law.law).needs_poses;
  if (!by_place && result.contacts == result.contacts_of_actuator[0]) return;  // the summary says it
  warn(fmt::format("{}: {} drove no actuator under the law {}{}", timeline, counted(result.contacts, "contact"),
                   options.law.law,
                   by_place
                       ? ": no sphere covered the place of an actuator deep enough; larger spheres, a map with more "
                         "actuators or less --full-depth help, and the law depth goes by regions"
                       : ""),
       options.common.verbosity());
}

/// Contacts that are fewer than the colliders are a reason to ask where the colliders were.
void ask_about_placement(OpenTrace& trace, const ReplayResult& result, const ReplayRun& run,
                         const ReplayOptions& options) {
  if (result.interrupted || result.contacts >= run.colliders || trace.people.size() > 1) return;
  PlacementQuestion question(trace.person().avatar);
  TraceFrame frame;
  trace.reader.rewind();
  while (trace.reader.next(frame)) question.see(frame);
  if (const auto doubt = question.ask())
    warn(fmt::format("{}: {} (record or import it again so)", options.trace, *doubt), options.common.verbosity());
}

/// What files of textures and contacts say about their origin.
std::map<std::string, std::string> attributes_of(const ReplayOptions& options, const Detector& detector) {
  std::map<std::string, std::string> attributes = {
      {"vestige_trace", options.trace}, {"vestige_detector", detector.name()}, {"vestige_commit", commit()}};
  const GlInfo gl = detector.gl_info();
  if (!gl.context.empty()) attributes.emplace("vestige_gl_renderer", gl.renderer);
  return attributes;
}

/// The planes that contacts and textures hold. Only spheres have a depth.
PlaneSet planes_of_outputs(const ReplayOptions& options, PlaneSet texture_planes, ColliderShape shape) {
  PlaneSet planes = kHashedPlanes;
  if (!options.textures.empty()) planes = planes | texture_planes;
  if (options.contacts.empty()) return planes;
  return planes | (shape == ColliderShape::kSpheres ? PlaneSet::all() : PlaneSet::all().without(Plane::kDepth));
}

/// Warns if the run's detector, or the one that it is compared with, ignores the radii of spheres. Returns whether the
/// run's does.
bool warn_of_ignored_radii(const ReplayOptions& options, const std::string& detector, OpenTrace& trace) {
  std::vector<std::string> tested_by = {detector};
  if (is_detector(options.verify)) tested_by.push_back(options.verify);
  warn_of_radii(tested_by, trace.reader, options.trace, options.common.verbosity());
  return !takes_radii(detector) && trace.reader.has_spheres();
}

/// Picks what --detector auto runs: for all people what suits the finest avatar.
std::optional<PickedPath> pick(const ReplayOptions& options, const OpenTrace& trace, std::size_t colliders) {
  if (options.choice.detector != "auto") return {};
  std::size_t triangles = 0;
  for (const TracedPerson& person : trace.people) triangles = std::max(triangles, person.avatar.triangles.size());
  return pick_path(triangles, colliders, options.choice.skip_kind());
}

/// The files of contacts and textures, where they are asked for.
class ResultFiles {
 public:
  ResultFiles(const ReplayOptions& options, const ReplayRun& run, PlaneSet texture_planes, ColliderShape shape) {
    const std::vector<TracedPerson>& people = run.trace.people;
    const auto attributes = attributes_of(options, run.detectors.first());
    if (!options.contacts.empty())
      contacts_ =
          make_contacts_file(options.contacts, options.common.overwrite(), attributes, {shape, people.size() > 1});
    if (options.textures.empty()) return;
    std::vector<std::string> names;
    names.reserve(people.size());
    for (const TracedPerson& person : people) names.push_back(person.name);
    texture_file_.emplace(options.textures, options.common.overwrite());
    textures_.emplace(texture_planes, run.colliders, attributes, names);
  }

  ContactsFile* contacts() { return contacts_.get(); }
  TextureExr* textures() { return textures_ ? &*textures_ : nullptr; }

  void commit() {
    if (textures_) textures_->write(*texture_file_);
    if (contacts_) contacts_->commit();
    if (texture_file_) texture_file_->commit();
  }

 private:
  std::unique_ptr<ContactsFile> contacts_;
  std::optional<TextureExr> textures_;
  std::optional<OutputFile> texture_file_;
};

/// Changes of the map are those of the only person.
std::vector<ReplayPerson> people_of(const OpenTrace& trace, const Timelines& timelines,
                                    std::span<const MapChange> changes) {
  std::vector<ReplayPerson> people;
  people.reserve(trace.people.size());
  for (std::size_t i = 0; i < trace.people.size(); ++i) {
    const Timelines::One* one = timelines.find(i);
    people.push_back({.avatar = trace.people[i].avatar,
                      .actuator_count = trace.people[i].map.actuator_count,
                      .timeline = one == nullptr ? nullptr : one->file.get(),
                      .drive = one == nullptr ? nullptr : one->drive.get(),
                      .changes = changes});
  }
  return people;
}

void run_replay(const ReplayOptions& options, Invocation& invocation) {
  const Verbosity verbosity = options.common.verbosity();
  std::vector<std::string> outputs = {options.contacts, options.textures, options.timeline, options.common.json};
  const std::vector<TimedMap> timed_maps = parse_map_at(options);
  const std::vector<PersonValue> maps = parse_maps(options.maps);
  options.law.check();
  std::vector<std::string> inputs = {options.trace, options.verify, options.law.actuator};
  for (const TimedMap& timed : timed_maps) inputs.insert(inputs.end(), {timed.file, sidecar_path(timed.file).string()});
  add_map_files(maps, inputs);
  check_outputs(outputs, inputs, options.common);
  if (options.textures == "-") refuse_terminal("--textures -");
  const PlaneSet texture_planes = parse_planes(options.planes);

  OpenTrace trace(options.trace, verbosity, People::kSeveral, options.threads);
  auto expected = read_expected(options.verify, trace.people.size());
  require_surfaces(trace, options.trace);
  check_people(timed_maps, trace, options);
  use_maps(maps, trace.people, options.trace, verbosity);
  const ColliderShape shape = trace.reader.has_spheres() ? ColliderShape::kSpheres : ColliderShape::kPoints;
  Timelines timelines(options, trace);
  timelines.add_paths_to(outputs);
  check_outputs(outputs, inputs, options.common);  // again, with those that the trace's people bring
  const Timelines::One* first = timelines.find(0);
  const std::vector<MapChange> changes =
      read_maps(timed_maps, trace.person(), first == nullptr ? nullptr : &first->drives, options);
  const PlaneSet verified = changes.empty() ? kHashedPlanes : kHashedPlanes | Plane::kTextureCoordinate;
  const PlaneSet planes = planes_of_outputs(options, texture_planes, shape) | timelines.planes() | verified;
  const std::vector<std::uint32_t> collider_ids = trace.reader.collider_ids();
  const std::optional<PickedPath> picked = pick(options, trace, collider_ids.size());
  DetectorTeam detectors(options.threads, [&] {
    return make_detectors(picked ? picked->detector : options.choice.detector, options.choice, trace.people, planes);
  });
  const Detector& detector = detectors.first();
  const bool ignores_radii = warn_of_ignored_radii(options, detector.name(), trace);
  const ReplayRun run = {options, trace, collider_ids.size(), picked, detectors, ignores_radii, timelines};
  const Verification verification = load_verification(options, trace, detector, verified, std::move(expected));

  catch_interrupts();  // before the first temporary file
  ResultFiles files(options, run, texture_planes, shape);
  timelines.open();
  const ReplayPlan plan = {.people = people_of(trace, timelines, changes),
                           .contacts = files.contacts(),
                           .textures = files.textures(),
                           .expectation = verification.expectation()};
  ReplayResult result;
  {
    Progress progress("Replaying", verbosity);
    result = replay(trace.reader, detectors, plan, [&](double share) { return progress.update(share); });
  }
  if (result.frames == 0) require_frames(trace.reader, options.trace);
  files.commit();
  timelines.commit();
  warn_of_gaps(result, trace, timed_maps, options);
  for (std::size_t i = 0; i < result.people.size(); ++i)
    if (const Timelines::One* one = timelines.find(i)) warn_of_silence(result.people[i], one->path, options);
  ask_about_placement(trace, result, run, options);

  print_summary(summary(result, run), outputs, options.common);
  write_json(options.common.json, to_json(result, run, invocation), options.common);
  invocation.exit_code = report_verification(options, result, verification, outputs);
  int damage = report_damage(trace.reader, options.trace, verbosity);
  if (result.interrupted || result.non_finite_frames + result.non_finite_segments != 0) damage = kDataLost;
  if (invocation.exit_code == kDone) invocation.exit_code = damage;
}

}  // namespace

void add_replay(CLI::App& program, Invocation& invocation) {
  auto options = std::make_shared<ReplayOptions>();
  CLI::App* verb = add_verb(program, "replay", "Run a trace through a collision detector",
                            "  vestige replay man.mcap --contacts contacts.csv --timeline timeline.csv\n"
                            "  vestige replay man.mcap --detector paper --textures textures.exr --json replay.json\n");
  verb->add_option("TRACE", options->trace, "The trace, or '-' for standard input")->required();
  add_detector_and_context(*verb, options->choice);
  add_detector_options(*verb, options->choice);
  verb->add_option(
          "--threads", options->threads,
          "Number of processor threads; the result is the same; of several, Hz counts reading and writing, too "
          "[default: 1; all cores if contacts, textures or a timeline are asked of detectors without OpenGL]")
      ->group(kDetectorGroup)
      ->check(help::whole_number(1, kMostThreads));
  const auto add_result = [&](const char* name, auto& value, const std::string& description) {
    return verb->add_option(name, value, description)->group("Results");
  };
  add_result("--contacts", options->contacts, "Write the contacts, one row each, as CSV or HDF5 (.h5, .hdf5)")
      ->type_name("OUT.csv|OUT.h5|-");
  add_result("--textures", options->textures,
             "Write the collision textures as OpenEXR: one row per frame, one column per collider, one part per person")
      ->type_name("OUT.exr|-");
  add_result("--planes", options->planes,
             "Planes of the textures, any of: actuator, t, triangle, barycentric, texture, position, speed, side, "
             "pressure, depth")
      ->capture_default_str()
      ->type_name("LIST");
  add_result(
      "--timeline", options->timeline,
      "Write the actuators' duties: as CSV, one row per frame, 0 to 255; as MPEG haptics (.hjif); or for bHaptics "
      "(.tact, at most 40 actuators); of person 2 OUT.2.csv")
      ->type_name("OUT.csv|OUT.hjif|OUT.tact|-");
  add_maps_option(*verb, options->maps, "Results");
  verb->add_option(
          "--map-at", options->map_at,
          "Use another actuator map, with as many actuators, from this time of the trace on; repeat for more maps")
      ->group("Results")
      ->type_name("TIME=FILE.png|TIME=LAYOUT")
      ->expected(1)
      ->take_all();
  add_result(
      "--verify", options->verify,
      fmt::format(
          "Compare with another detector ({}), or with the --contacts (.csv, .h5) or --json of an earlier replay; "
          "exit 4 if contacts differ by more than their times",
          fmt::join(detector_names(), ", ")))
      ->type_name("DETECTOR|FILE");
  add_law_options(*verb, options->law, kIntensityGroup);
  add_common_options(*verb, options->common);
  // Flags that would do nothing are refused.
  verb->get_option("--planes")->needs(verb->get_option("--textures"));
  for (CLI::Option* option : verb->get_options())
    if (option->get_group() == kIntensityGroup) option->needs(verb->get_option("--timeline"));
  verb->callback([options, &invocation] {
    if (options->threads == 0) options->threads = default_threads(*options);
    run_replay(*options, invocation);
  });
}

}  // namespace vestige::cli
