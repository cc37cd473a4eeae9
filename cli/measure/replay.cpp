#include "analysis/run/replay.hpp"

#include <fmt/format.h>

#include <map>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "analysis/base/provenance.hpp"
#include "cli/choices/detectors.hpp"
#include "cli/choices/law_choice.hpp"
#include "cli/choices/scene.hpp"
#include "cli/help/validators.hpp"
#include "cli/measure/replay_check.hpp"
#include "cli/measure/replay_maps.hpp"
#include "cli/measure/replay_options.hpp"
#include "cli/verbs.hpp"
#include "detector/detectors/path_choice.hpp"
#include "traces/base/error.hpp"
#include "traces/base/number_text.hpp"
#include "traces/questions/placement_question.hpp"

namespace vestige::cli {

namespace {

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

nlohmann::ordered_json to_json(const Comparison& comparison, const std::string& against) {
  return {{"against", against},
          {"expected", comparison.expected},
          {"differing", comparison.differing()},
          {"missing", comparison.missing},
          {"extra", comparison.extra},
          {"other_triangle", comparison.other_triangle},
          {"other_actuator", comparison.other_actuator},
          {"other_t", comparison.other_t},
          {"largest_t_difference", comparison.largest_t_difference}};
}

nlohmann::ordered_json to_json(const SkinningError& skinning) {
  return {
      {"frames", skinning.frames},
      {"vertices", skinning.vertices},
      {"identical_to_cpu", skinning.identical ? nlohmann::ordered_json(*skinning.identical) : nlohmann::ordered_json()},
      {"largest_error_m", skinning.largest_m},
      {"largest_error_cpu_m", skinning.largest_cpu_m},
      {"height_m", skinning.height_m},
      {"largest_error_of_height", skinning.largest_m / skinning.height_m}};
}

/// Whether the GPU passes pairs on to the CPU, which is worth a line.
bool captures(const Detector& detector) {
  return std::string_view(detector.name()) == "geometry";
}

/// A trace under replay, and what runs it.
struct Run {
  const ReplayOptions& options;
  const OpenTrace& trace;
  std::size_t colliders;
  std::optional<PickedPath> picked;  ///< by --detector auto
  const Detector& detector;
  bool ignores_radii;                  ///< of colliders that have one
  const DriveMaker* drives = nullptr;  ///< of the timeline; null without one
};

std::string describe_picked(const PickedPath& picked) {
  return fmt::format("{}, skip {}", picked.detector, picked.skip == Skip::kOn ? "on" : "off");
}

nlohmann::ordered_json to_json(const ReplayResult& result, const Run& run, const Invocation& invocation) {
  const ReplayOptions& options = run.options;
  const OpenTrace& trace = run.trace;
  nlohmann::ordered_json json = provenance(invocation.argv);
  json["trace"] = options.trace;
  json["detector"] = run.detector.name();
  json["approximate"] = run.detector.is_approximate();
  json["ignores_radii"] = run.ignores_radii;
  if (const auto kept = run.detector.triangles_kept()) json["triangles_kept"] = *kept;
  if (run.picked) {
    json["picked"] = describe_picked(*run.picked);
    json["why"] = run.picked->why;
  }
  json["threads"] = options.threads;
  json["method"] = options.choice.method;
  json["skip"] = options.choice.skip;
  json["surface"] = options.choice.surface;
  json["hold_ms"] = options.law.hold_ms;
  if (run.drives != nullptr) json["law"] = run.drives->to_json();
  for (const std::string& map : options.map_at) json["map_at"].push_back(map);
  json["gl"] = vestige::to_json(run.detector.gl_info());
  json["avatar"] = vestige::to_json(trace.avatar);
  if (options.choice.surface == "mapped") json["triangles_left_out"] = run.detector.triangles_left_out();
  json["frames"] = result.frames;
  json["frames_skipped"] = result.work.frames_skipped;
  json["colliders"] = run.colliders;
  json["contacts"] = result.contacts;
  json["unsure"] = result.work.unsure;
  json["texture_hash"] = result.texture_hash;
  json["pairs_tested"] = result.work.pairs_tested;
  if (captures(run.detector)) {
    json["pairs_captured"] = result.work.pairs_captured;
    json["pairs_meeting"] = result.work.pairs_meeting;
  }
  json["origin_changes"] = result.origin_changes;
  json["non_finite_frames"] = result.non_finite_frames;
  json["non_finite_segments"] = result.non_finite_segments;
  if (result.first_non_finite) json["first_non_finite_frame"] = *result.first_non_finite;
  json["reading_s"] = result.reading_s;
  json["detection_s"] = result.detection_s;
  json["hz"] = static_cast<double>(result.frames) / result.detection_s;
  nlohmann::ordered_json actuators = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < trace.map.actuator_count; ++i)
    actuators.push_back({{"name", trace.map.names[i]}, {"contacts", result.contacts_of_actuator[i + 1]}});
  json["actuators"] = actuators;
  json["skinning"] = to_json(result.skinning);
  if (result.comparison) json["verify"] = to_json(*result.comparison, options.verify);
  json["complete"] = trace.reader.complete() && !result.interrupted;
  return json;
}

std::string summary(const ReplayResult& result, const Run& run) {
  const Detector& detector = run.detector;
  const ActuatorMap& map = run.trace.map;
  const GlInfo gl = detector.gl_info();
  const std::string where = gl.context.empty() ? "" : fmt::format(" on {} ({})", gl.context, gl.renderer);
  std::string text =
      fmt::format("{}{}{}: {}, {}, {}, {:.0f} Hz\n", detector.name(), detector.is_approximate() ? " (approximate)" : "",
                  where, counted(result.frames, "frame"), counted(run.colliders, "collider"),
                  counted(result.contacts, "contact"), static_cast<double>(result.frames) / result.detection_s);
  if (run.picked) text += fmt::format("picked {} ({})\n", describe_picked(*run.picked), run.picked->why);
  const auto add_row = [&](std::string_view actuator, std::uint64_t contacts) {
    text += fmt::format("  {:<24} {:>8} {}\n", actuator, contacts, contacts == 1 ? "contact" : "contacts");
  };
  for (std::size_t i = 0; i < map.actuator_count; ++i) add_row(map.names[i], result.contacts_of_actuator[i + 1]);
  add_row("(no actuator)", result.contacts_of_actuator[0]);
  if (const auto kept = detector.triangles_kept())
    text += fmt::format("kept: {} of {} triangles\n", *kept, run.trace.avatar.triangles.size());
  if (detector.triangles_left_out() != 0)
    text += fmt::format("left out: {} of {} triangles, which no actuator covers\n", detector.triangles_left_out(),
                        run.trace.avatar.triangles.size());
  text += fmt::format("skinning by {}: at most {:.2g} of the avatar's height from the double-precision reference{}\n",
                      detector.skins_in_shader() ? "a shader" : "the CPU",
                      result.skinning.largest_m / result.skinning.height_m,
                      result.skinning.identical ? fmt::format("; {} of {} vertices have the same bits as on the CPU",
                                                              *result.skinning.identical, result.skinning.vertices)
                                                : "");
  if (captures(detector))
    text += fmt::format("captured {} of {} pairs; {} of these pairs touch\n", result.work.pairs_captured,
                        result.work.pairs_tested, result.work.pairs_meeting);
  return text + fmt::format("texture_hash {}\n", result.texture_hash);
}

/// Says why there may be fewer contacts than expected.
void warn_of_gaps(const ReplayResult& result, const std::vector<TimedMap>& timed_maps, const ReplayOptions& options) {
  const Verbosity verbosity = options.common.verbosity();
  if (result.interrupted) warn(fmt::format("stopped after {} frames", result.frames), verbosity);
  for (std::size_t i = result.map_changes; i < timed_maps.size() && !result.interrupted; ++i)
    warn(fmt::format("--map-at {}={}: the trace ends before that time", timed_maps[i].time_s, timed_maps[i].file),
         verbosity);
  if (result.non_finite_frames + result.non_finite_segments != 0)
    warn(fmt::format(
             "{}: {} poses and the ends of {} segments are not finite, the first in frame {}; they fired nothing",
             options.trace, result.non_finite_frames, result.non_finite_segments, *result.first_non_finite),
         verbosity);
}

/// Contacts that nobody feels are a reason to ask for another law or map.
void warn_of_silence(const ReplayResult& result, const ReplayOptions& options) {
  if (options.timeline.empty() || result.any_vibrates || result.contacts == 0) return;
  const bool by_place = law_named(options.law.law).needs_poses;
  if (!by_place && result.contacts == result.contacts_of_actuator[0]) return;  // the summary says it
  warn(fmt::format("{}: {} drove no actuator under the law {}{}", options.timeline, counted(result.contacts, "contact"),
                   options.law.law,
                   by_place
                       ? ": no sphere covered the place of an actuator deep enough; larger spheres, a map with more "
                         "actuators or less --full-depth help, and the law depth goes by regions"
                       : ""),
       options.common.verbosity());
}

/// Contacts that are fewer than the colliders are a reason to ask where the colliders were.
void ask_about_placement(OpenTrace& trace, const ReplayResult& result, const Run& run, const ReplayOptions& options) {
  if (result.interrupted || result.contacts >= run.colliders) return;
  PlacementQuestion question(trace.avatar);
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

void run_replay(const ReplayOptions& options, Invocation& invocation) {
  const Verbosity verbosity = options.common.verbosity();
  const std::vector<std::string> outputs = {options.contacts, options.textures, options.timeline, options.common.json};
  const std::vector<TimedMap> timed_maps = parse_map_at(options);
  options.law.check();
  std::vector<std::string> inputs = {options.trace, options.verify, options.law.actuator};
  for (const TimedMap& timed : timed_maps) inputs.push_back(timed.file);
  check_outputs(outputs, inputs, options.common);
  if (options.textures == "-") refuse_terminal("--textures -");
  const PlaneSet texture_planes = parse_planes(options.planes);
  auto expected = read_expected(options.verify);

  OpenTrace trace(options.trace, verbosity);
  require_surface(trace.avatar, options.trace + ", avatar.glb");
  if (!options.timeline.empty() && trace.map.actuator_count == 0)
    throw UsageError("--timeline", fmt::format("there is no actuator in {}, so nothing to write", options.trace),
                     "give the trace an actuator map with 'vestige record --map', or leave --timeline out");
  const std::vector<std::uint32_t> collider_ids = trace.reader.collider_ids();
  const ColliderShape shape = trace.reader.has_spheres() ? ColliderShape::kSpheres : ColliderShape::kPoints;
  PlaneSet planes = planes_of_outputs(options, texture_planes, shape);
  std::optional<DriveMaker> drives;
  if (!options.timeline.empty()) {
    require_spheres(std::span(&options.law.law, 1), trace.reader.has_spheres(), options.trace);
    drives.emplace(options.law, trace.avatar, trace.map);
  }
  if (drives) planes = planes | drives->planes();
  const std::vector<MapChange> changes = read_maps(timed_maps, trace, drives ? &*drives : nullptr, options);
  const PlaneSet verified = changes.empty() ? kHashedPlanes : kHashedPlanes | Plane::kTextureCoordinate;
  planes = planes | verified;
  std::optional<PickedPath> picked;
  if (options.choice.detector == "auto")
    picked = pick_path(trace.avatar.triangles.size(), collider_ids.size(), options.choice.skip_kind());
  DetectorTeam detectors(options.threads, [&] {
    return make_detector(picked ? picked->detector : options.choice.detector, options.choice.context, options.choice,
                         trace.avatar, trace.map, planes);
  });
  const bool ignores_radii = warn_of_ignored_radii(options, detectors.first().name(), trace);
  const Run run = {options,           trace,         collider_ids.size(),        picked,
                   detectors.first(), ignores_radii, drives ? &*drives : nullptr};
  const Verification verification = load_verification(options, trace, run.detector, verified, std::move(expected));

  catch_interrupts();  // before the first temporary file
  std::unique_ptr<ContactsFile> contacts;
  std::optional<TextureExr> textures;
  std::optional<OutputFile> texture_file;
  std::unique_ptr<TimelineFile> timeline;
  if (!options.contacts.empty())
    contacts =
        make_contacts_file(options.contacts, options.common.overwrite(), attributes_of(options, run.detector), shape);
  if (!options.timeline.empty())
    timeline = make_timeline(options.timeline, options.common.overwrite(), trace.map.names);
  if (!options.textures.empty()) {
    texture_file.emplace(options.textures, options.common.overwrite());
    textures.emplace(texture_planes, collider_ids.size(), attributes_of(options, run.detector));
  }

  const std::unique_ptr<ActuatorDrive> drive = drives ? drives->make() : nullptr;
  ReplayResult result;
  {
    Progress progress("Replaying", verbosity);
    const ReplayOutputs sinks = {contacts.get(), textures ? &*textures : nullptr, timeline.get(), drive.get()};
    const ReplayPlan plan = {trace.avatar, trace.map.actuator_count, sinks, verification.expectation(), changes};
    result = replay(trace.reader, detectors, plan, [&](double share) { return progress.update(share); });
  }
  if (result.frames == 0) require_frames(trace.reader, options.trace);
  if (textures) textures->write(*texture_file);
  if (contacts) contacts->commit();
  if (texture_file) texture_file->commit();
  if (timeline) timeline->commit();
  warn_of_gaps(result, timed_maps, options);
  warn_of_silence(result, options);
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
  verb->add_option("--threads", options->threads,
                   "Number of processor threads that detect, frame by frame; the result is the same")
      ->group(kDetectorGroup)
      ->capture_default_str()
      ->check(help::whole_number(1, 256));
  const auto add_result = [&](const char* name, auto& value, const std::string& description) {
    return verb->add_option(name, value, description)->group("Results");
  };
  add_result("--contacts", options->contacts, "Write the contacts, one row each, as CSV or HDF5 (.h5, .hdf5)")
      ->type_name("OUT.csv|OUT.h5|-");
  add_result("--textures", options->textures,
             "Write the collision textures as OpenEXR: one row per frame, one column per collider")
      ->type_name("OUT.exr|-");
  add_result("--planes", options->planes,
             "Planes of the textures, any of: actuator, t, triangle, barycentric, texture, position, speed, side, "
             "pressure")
      ->capture_default_str()
      ->type_name("LIST");
  add_result(
      "--timeline", options->timeline,
      "Write the actuators' duties: as CSV, one row per frame, 0 to 255; as MPEG haptics (.hjif); or for bHaptics "
      "(.tact, at most 40 actuators)")
      ->type_name("OUT.csv|OUT.hjif|OUT.tact|-");
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
  verb->callback([options, &invocation] { run_replay(*options, invocation); });
}

}  // namespace vestige::cli
