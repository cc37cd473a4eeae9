#include "cli/measure/replay_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "analysis/base/provenance.hpp"
#include "traces/base/number_text.hpp"

namespace vestige::cli {

namespace {

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

/// Returns the errors of the person with the largest ones for their height.
const SkinningError& worst_skinning(const ReplayResult& result) {
  const auto of_height = [](const PersonResult& person) {
    return person.skinning.height_m > 0 ? person.skinning.largest_m / person.skinning.height_m : 0;
  };
  return std::ranges::max_element(result.people, {}, of_height)->skinning;
}

/// Whether the GPU passes pairs on to the CPU, which is worth a line.
bool captures(const Detector& detector) {
  const std::string_view name = detector.name();
  return name == "geometry" || name == "compute";
}

nlohmann::ordered_json actuators_of(const TracedPerson& person, const PersonResult& result) {
  nlohmann::ordered_json actuators = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < person.map.actuator_count; ++i)
    actuators.push_back({{"name", person.map.names[i]}, {"contacts", result.contacts_of_actuator[i + 1]}});
  return actuators;
}

nlohmann::ordered_json to_json(std::size_t i, const PersonResult& result, const ReplayRun& run) {
  const TracedPerson& person = run.trace.people[i];
  const Detector& detector = run.detectors.first(i);
  nlohmann::ordered_json json = {{"name", person.name}};
  json.update(vestige::to_json(person.avatar));
  if (const auto kept = detector.triangles_kept()) json["triangles_kept"] = *kept;
  if (run.options.choice.surface == "mapped") json["triangles_left_out"] = detector.triangles_left_out();
  if (const Timelines::One* timeline = run.timelines.find(i)) json["law"] = timeline->drives.to_json();
  json["contacts"] = result.contacts;
  json["texture_hash"] = result.texture_hash;
  json["contacts_hash"] = result.contacts_hash;
  json["non_finite_frames"] = result.non_finite_frames;
  json["non_finite_segments"] = result.non_finite_segments;
  json["actuators"] = actuators_of(person, result);
  json["skinning"] = to_json(result.skinning);
  return json;
}

/// The rows of a person's actuators, and what the detector left out of the person's skin.
std::string summary_of(const TracedPerson& person, const PersonResult& result, const Detector& detector) {
  std::string text;
  const auto add_row = [&](std::string_view actuator, std::uint64_t contacts) {
    text += fmt::format("  {:<24} {:>8} {}\n", actuator, contacts, contacts == 1 ? "contact" : "contacts");
  };
  const ActuatorMap& map = person.map;
  for (std::size_t i = 0; i < map.actuator_count; ++i) add_row(map.names[i], result.contacts_of_actuator[i + 1]);
  add_row("(no actuator)", result.contacts_of_actuator[0]);
  if (const auto kept = detector.triangles_kept())
    text += fmt::format("kept: {} of {} triangles\n", *kept, person.avatar.triangles.size());
  if (detector.triangles_left_out() != 0)
    text += fmt::format("left out: {} of {} triangles, which no actuator covers\n", detector.triangles_left_out(),
                        person.avatar.triangles.size());
  return text;
}

std::string describe_picked(const PickedPath& picked) {
  return fmt::format("{}, skip {}", picked.detector, picked.skip == Skip::kOn ? "on" : "off");
}

}  // namespace

nlohmann::ordered_json to_json(const ReplayResult& result, const ReplayRun& run, const Invocation& invocation) {
  const ReplayOptions& options = run.options;
  const OpenTrace& trace = run.trace;
  const Detector& detector = run.detectors.first();
  nlohmann::ordered_json json = provenance(invocation.argv);
  json["trace"] = options.trace;
  json["detector"] = detector.name();
  json["approximate"] = detector.is_approximate();
  json["ignores_radii"] = run.ignores_radii;
  if (const auto kept = detector.triangles_kept()) json["triangles_kept"] = *kept;
  if (run.picked) {
    json["picked"] = describe_picked(*run.picked);
    json["why"] = run.picked->why;
  }
  json["threads"] = options.threads;
  json["method"] = options.choice.method;
  json["skip"] = options.choice.skip;
  json["surface"] = options.choice.surface;
  json["hold_ms"] = options.law.hold_ms;
  for (std::size_t i = 0; i < trace.people.size() && !json.contains("law"); ++i)
    if (const Timelines::One* timeline = run.timelines.find(i)) json["law"] = timeline->drives.to_json();
  for (const std::string& map : options.maps) json["map"].push_back(map);
  for (const std::string& map : options.map_at) json["map_at"].push_back(map);
  json["gl"] = vestige::to_json(detector.gl_info());
  json["avatar"] = vestige::to_json(trace.person().avatar);
  if (options.choice.surface == "mapped") json["triangles_left_out"] = detector.triangles_left_out();
  json["frames"] = result.frames;
  json["frames_skipped"] = result.work.frames_skipped;
  json["colliders"] = run.colliders;
  json["contacts"] = result.contacts;
  json["unsure"] = result.work.unsure;
  json["texture_hash"] = result.texture_hash;
  json["contacts_hash"] = result.contacts_hash;
  json["pairs_tested"] = result.work.pairs_tested;
  if (captures(detector)) {
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
  json["actuators"] = actuators_of(trace.person(), result.people.front());
  json["avatars"] = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < trace.people.size(); ++i) json["avatars"].push_back(to_json(i, result.people[i], run));
  json["skinning"] = to_json(worst_skinning(result));
  if (result.comparison) json["verify"] = to_json(*result.comparison, options.verify);
  json["complete"] = trace.reader.complete() && !result.interrupted;
  return json;
}

std::string summary(const ReplayResult& result, const ReplayRun& run) {
  const Detector& detector = run.detectors.first();
  const GlInfo gl = detector.gl_info();
  const std::string where = gl.context.empty() ? "" : fmt::format(" on {} ({})", gl.context, gl.renderer);
  std::string text =
      fmt::format("{}{}{}: {}, {}, {}, {:.0f} Hz (threads: {})\n", detector.name(),
                  detector.is_approximate() ? " (approximate)" : "", where, counted(result.frames, "frame"),
                  counted(run.colliders, "collider"), counted(result.contacts, "contact"),
                  static_cast<double>(result.frames) / result.detection_s, run.options.threads);
  if (run.picked) text += fmt::format("picked {} ({})\n", describe_picked(*run.picked), run.picked->why);
  const std::vector<TracedPerson>& people = run.trace.people;
  for (std::size_t i = 0; i < people.size(); ++i) {
    const PersonResult& found = result.people[i];
    if (people.size() > 1) text += fmt::format("{}: {}\n", people[i].name, counted(found.contacts, "contact"));
    text += summary_of(people[i], found, run.detectors.first(i));
  }
  const SkinningError& skinning = worst_skinning(result);
  text += fmt::format("skinning by {}: at most {:.2g} of the avatar's height from the double-precision reference{}\n",
                      detector.skins_in_shader() ? "a shader" : "the CPU", skinning.largest_m / skinning.height_m,
                      skinning.identical ? fmt::format("; {} of {} vertices have the same bits as on the CPU",
                                                       *skinning.identical, skinning.vertices)
                                         : "");
  if (captures(detector))
    text += fmt::format("captured {} of {} pairs; {} of these pairs touch\n", result.work.pairs_captured,
                        result.work.pairs_tested, result.work.pairs_meeting);
  return text + fmt::format("texture_hash {}\n", result.texture_hash);
}

}  // namespace vestige::cli
