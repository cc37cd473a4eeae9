#include "analysis/explain/file_kinds.hpp"

#include <fnmatch.h>

#include <algorithm>
#include <vector>

#include "analysis/explain/fields.hpp"

namespace vestige {

namespace {

using enum FileFormat;

void add(std::vector<FileKind>& all, std::vector<FileKind> some) {
  all.insert(all.end(), some.begin(), some.end());
}

std::vector<FileKind> detection_kinds() {
  return {
      {"contacts.csv", kCsv, "Contacts, a row for each", "vestige replay --contacts OUT.csv", contact_fields()},
      {"contacts.h5", kHdf5, "Contacts, a list for each column", "vestige replay --contacts OUT.h5", contact_fields()},
      {"textures.exr", kExr, "Collision textures: a row for each frame, a column for each collider, by ascending id",
       "vestige replay --textures OUT.exr", texture_fields()},
      {"timeline.csv", kCsv, "Duties of the actuators, a row for each frame", "vestige replay --timeline OUT.csv",
       timeline_fields()},
      {"timeline.hjif", kJson, "Duties of the actuators, for MPEG haptics", "vestige replay --timeline OUT.hjif",
       hjif_fields()},
      {"timeline.tact", kJson, "Duties of the actuators, for bHaptics", "vestige replay --timeline OUT.tact",
       tact_fields()},
      {"replay.json", kJson, "A replay", "vestige replay --json OUT.json", replay_fields()},
      {"view.json", kJson, "A page that shows a trace", "vestige view --json OUT.json", view_fields()},
      {"stream.json", kJson, "A stream to the vest", "vestige stream --json OUT.json", stream_fields()},
      {"stream.csv", kCsv, "What became of each changed state of a stream or a live session",
       "vestige stream --log OUT.csv, vestige live --log OUT.csv", stream_log_fields()},
      {"live.json", kJson, "A live session", "vestige live --json OUT.json", live_fields()},
      {"vest_check.json", kJson, "A check of the vest", "vestige vest check --json OUT.json", vest_check_fields()}};
}

std::vector<FileKind> measurement_kinds() {
  return {
      {"sweep.json", kJson, "Frequency by number of colliders", "vestige sweep -o DIR", sweep_fields()},
      {"frame_times.csv.zst", kCsv, "Duration of each frame, at most 100 passes of a point", "vestige sweep -o DIR",
       frame_time_fields()},
      {"growth.json", kJson, "Cost by number of colliders and of triangles", "vestige growth -o DIR", growth_fields()},
      {"compare.json", kJson, "What became slower or faster", "vestige compare A B --json OUT.json", compare_fields()},
      {"accuracy.json", kJson, "Errors of detectors", "vestige accuracy -o DIR", accuracy_fields()},
      {"run.json of accuracy", kJson, "Run times of detectors, beside their errors", "vestige accuracy -o DIR",
       accuracy_run_fields()},
      {"accuracy, both", kJson, "Errors and run times of detectors", "vestige accuracy --json OUT.json",
       accuracy_whole_fields()},
      {"stress.json", kJson, "Errors on hostile cases", "vestige stress -o DIR", stress_fields()},
      {"run.json of stress", kJson, "Origin of a stress test", "vestige stress -o DIR", stress_run_fields()},
      {"stress, both", kJson, "Errors on hostile cases, with their origin", "vestige stress --json OUT.json",
       stress_whole_fields()},
      {"query.json", kJson, "Answers to queries with known truth", "vestige query --json OUT.json", query_fields()},
      {"claims.json", kJson, "What result files show", "vestige claims --json OUT.json", claim_fields()}};
}

std::vector<FileKind> batch_kinds() {
  return {
      {"scores.csv", kCsv, "Scores: a row for each map, trace and law", "vestige batch -o DIR", score_table_fields()},
      {"scores.json", kJson, "Scores, and what the metrics are", "vestige batch -o DIR", score_fields()},
      {"ranking.csv", kCsv, "Ranking: a row for each map and law, means over traces", "vestige batch -o DIR",
       ranking_table_fields()},
      {"ranking_by_scenario.csv", kCsv, "Ranking by each scenario alone", "vestige batch -o DIR",
       scenario_ranking_table_fields()},
      {"ranking.json", kJson, "The rankings", "vestige batch -o DIR", ranking_fields()},
      {"run.json of batch", kJson, "A batch: origin, inputs, failures, durations; with --json, the ranking too",
       "vestige batch -o DIR, vestige batch --json OUT.json", batch_run_fields()},
      {"items/NAME.json", kJson, "Scores of one trace", "vestige batch -o DIR", batch_item_fields()},
      {"times/NAME.json", kJson, "How long one trace took", "vestige batch -o DIR", batch_times_fields()},
      {"contacts/NAME.csv", kCsv, "Contacts of one trace", "vestige batch -o DIR", batch_contact_fields()}};
}

std::vector<FileKind> trace_kinds() {
  return {
      {"poses.csv", kCsv, "Poses, a row for each frame", "vestige export -o DIR", pose_table_fields()},
      {"colliders.csv", kCsv, "Colliders, a row for each collider and frame", "vestige export -o DIR",
       collider_table_fields()},
      {"session.json", kJson, "Names, and which way avatars face", "vestige export -o DIR", session_fields()},
      {"trace.ndjson", kLines, "Frames, a line of JSON for each", "vestige export -o OUT.ndjson", frame_line_fields()},
      {"trace.h5", kHdf5, "A whole trace; with --contacts, its contacts too", "vestige export -o OUT.h5",
       trace_hdf5_fields()},
      {"record.json", kJson, "A recording", "vestige record --json OUT.json", record_fields()},
      {"import.json", kJson, "An import", "vestige import --json OUT.json", import_fields()},
      {"export.json", kJson, "An export", "vestige export --json OUT.json", export_fields()},
      {"inspect.json", kJson, "What an MCAP file holds", "vestige inspect --json OUT.json", inspect_fields()},
      {"doctor.json", kJson, "What is wrong with files", "vestige doctor --json OUT.json", doctor_fields()},
      {"recover.json", kJson, "What was saved of a damaged file", "vestige recover --json OUT.json", recover_fields()},
      {"trim.json", kJson, "Part of a file", "vestige trim --json OUT.json", rewriting_fields()},
      {"recompress.json", kJson, "A file that was compressed anew", "vestige recompress --json OUT.json",
       rewriting_fields()},
      {"merge.json", kJson, "Parts that were joined", "vestige merge --json OUT.json", merge_fields()},
      {"viz.json", kJson, "A trace that gained what viewers draw", "vestige viz --json OUT.json", viz_fields()},
      {"layout.json", kJson, "A layout for Foxglove and Lichtblick", "vestige viz --layout OUT.json",
       viewer_layout_fields()},
      {"cat.json", kJson, "What was printed", "vestige cat --json OUT.json", cat_fields()}};
}

std::vector<FileKind> setup_kinds() {
  return {
      {"avatar.json", kJson, "An avatar", "vestige avatar --json OUT.json", avatar_file_fields()},
      {"regions.json", kJson, "Regions to make a map of", "vestige map make --save-regions OUT.json", region_fields()},
      {"map.json", kJson, "The names beside an actuator map", "vestige map make -o OUT.png", map_sidecar_fields()},
      {"map_make.json", kJson, "A map that was made", "vestige map make --json OUT.json", map_make_fields()},
      {"map_check.json", kJson, "What is wrong with a map", "vestige map check --json OUT.json", map_check_fields()},
      {"map_parts.json", kJson, "The parts of a body", "vestige map parts --json OUT.json", map_parts_fields()},
      {"devices.json", kJson, "OpenGL contexts of a machine", "vestige devices --json OUT.json", device_fields()},
      {"explain.json", kJson, "What files mean", "vestige explain --json OUT.json", explain_fields()}};
}

}  // namespace

std::span<const FileKind> file_kinds() {
  static const std::vector<FileKind> kinds = [] {
    std::vector<FileKind> all = detection_kinds();
    add(all, measurement_kinds());
    add(all, batch_kinds());
    add(all, trace_kinds());
    add(all, setup_kinds());
    return all;
  }();
  return kinds;
}

std::string path_of(std::string_view below, std::string_view name) {
  return below.empty() ? std::string(name) : std::string(below) + "/" + std::string(name);
}

namespace {

bool matches(std::string_view pattern, std::string_view name) {
  return ::fnmatch(std::string(pattern).c_str(), std::string(name).c_str(), FNM_NOESCAPE) == 0;
}

/// Whether a name of the field `pattern` can stand below `path`.
bool stands_below(std::string_view pattern, std::string_view path) {
  const auto levels = std::ranges::count(path, '/');
  std::size_t end = pattern.find('/');
  for (std::ptrdiff_t i = 0; i < levels && end != std::string_view::npos; ++i) end = pattern.find('/', end + 1);
  return end != std::string_view::npos && matches(pattern.substr(0, end), path);
}

}  // namespace

PlacedField find_field(const FileKind& kind, const std::string& name) {
  PlacedField by_pattern = {name, nullptr};
  for (const FieldGroup& group : kind.groups) {
    std::string_view rest = name;
    if (!group.below.empty()) {
      if (!rest.starts_with(group.below) || rest.size() <= group.below.size() || rest[group.below.size()] != '/')
        continue;
      rest.remove_prefix(group.below.size() + 1);
    }
    for (const Field& field : group.fields) {
      if (field.name == rest) return {name, &field};
      if (by_pattern.field == nullptr && field.name.find('*') != std::string_view::npos && matches(field.name, rest))
        by_pattern = {path_of(group.below, field.name), &field};
    }
  }
  return by_pattern;
}

std::vector<std::string> required_names(const FileKind& kind) {
  const Field& version = version_field().front();
  std::vector<std::string> names = {path_of(kind.groups.front().below, kind.groups.front().fields.front().name)};
  if (find_field(kind, std::string(version.name)).field == &version) names.emplace_back(version.name);
  return names;
}

bool holds_fields(const FileKind& kind, std::string_view path) {
  for (const FieldGroup& group : kind.groups)
    for (const Field& field : group.fields)
      if (stands_below(path_of(group.below, field.name), path)) return true;
  return false;
}

}  // namespace vestige
