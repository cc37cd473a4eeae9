#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "analysis/base/provenance.hpp"
#include "cli/choices/limits_choice.hpp"
#include "cli/choices/live_choice.hpp"
#include "cli/choices/scene.hpp"
#include "cli/choices/scene_choice.hpp"
#include "cli/choices/snapshots.hpp"
#include "cli/files/export_formats.hpp"
#include "cli/files/people_choice.hpp"
#include "cli/help/validators.hpp"
#include "cli/verbs.hpp"
#include "traces/base/error.hpp"
#include "traces/base/number_text.hpp"
#include "traces/questions/placement_question.hpp"
#include "traces/recording/recorder.hpp"
#include "traces/recording/sampled_scene.hpp"
#include "traces/scene/colliders.hpp"
#include "traces/scene/people.hpp"
#include "traces/trace_file/trace_format.hpp"

namespace vestige::cli {

namespace {

constexpr double kFarthest_m = 1e7;  // detector/CONTRACT.md, 2

/// When a live recording's chunks are closed, so that with the time until somebody looks nothing waits for 100 ms.
constexpr double kLiveChunk_s = 0.08;

/// Beyond the ids that OSC can send.
constexpr std::uint64_t kFirstLiveLimb = std::uint64_t{1} << 31U;

/// A radius may come at any time.
constexpr ColliderShape kLiveShape = ColliderShape::kSpheres;

struct RecordOptions {
  CommonOptions common;
  SceneChoice scene;
  std::vector<PersonChoice> people;
  LimitsChoice limits;
  LiveChoice live;
  RecordingSettings recording;
  bool has_duration = false;
  bool is_touch = false;  ///< --colliders touch: people who bring their colliders
  std::string origin = "0,0,0";
  std::string compression = "zstd";
  bool viz = false;
  std::string output;
};

void require_near(const glm::dvec3& position_m, const char* flag, const std::string& text) {
  if (std::max({std::abs(position_m.x), std::abs(position_m.y), std::abs(position_m.z)}) <= kFarthest_m) return;
  throw UsageError(flag, fmt::format("'{}' is farther away than 1e7 m", text),
                   "choose a nearer place: beyond 1e7 m, positions are too coarse for contacts");
}

std::vector<TracePerson> recorded_people(const std::vector<Person>& people) {
  std::vector<TracePerson> recorded;
  recorded.reserve(people.size());
  for (const Person& person : people) recorded.push_back(person.scene.person());
  return recorded;
}

RecordingSettings settings_of(const RecordOptions& options) {
  RecordingSettings settings = options.recording;
  settings.origin_m = parse_vector(options.origin, "--origin");
  if (!options.live.is_lines())  // which have no rate
    refuse_too_many_frames(settings.rate_hz * settings.duration_s, "--duration", "lower --duration or --rate");
  require_near(settings.origin_m, "--origin", options.origin);
  return settings;
}

Session session_of(const RecordOptions& options, const std::vector<Person>& people, const Invocation& invocation) {
  Session session = provenance_texts(invocation.argv);
  if (options.live.is_live()) {
    for (std::size_t k = 0; k < options.live.sources.size(); ++k)
      session[trace_format::numbered("live", k)] = options.live.sources[k];
    if (!options.live.is_lines()) session["rate_hz"] = fmt::format("{}", options.recording.rate_hz);
    return session;
  }
  session["rate_hz"] = fmt::format("{}", options.recording.rate_hz);
  for (std::size_t k = 0; k < people.size(); ++k) {
    const Animation* animation = people[k].animation;
    session[trace_format::numbered("animation", k)] = animation == nullptr ? "" : animation->name;
    if (!options.people[k].limbs.empty()) session[trace_format::numbered("limbs", k)] = options.people[k].limbs;
    if (!options.people[k].at.empty()) session[trace_format::numbered("at", k)] = options.people[k].at;
  }
  session["colliders"] = options.is_touch ? kTouch : options.scene.colliders;
  if (!options.scene.radius.text.empty()) session["radius"] = options.scene.radius.text;
  session["seed"] = fmt::format("{}", options.common.seed);
  if (options.scene.from_file()) note_collider_convention(options.scene.convention, session);
  return session;
}

/// `colliders` and `limbs` are null in a live recording.
TraceWriterOptions writing_of(const RecordOptions& options, const ColliderSource* colliders,
                              const CarriedLimbs* limbs) {
  TraceWriterOptions writing;
  writing.overwrite = options.common.overwrite();
  if (options.compression == "lz4") writing.compression = Compression::kLz4;
  if (options.compression == "none") writing.compression = Compression::kNone;
  if (options.viz) writing.viz = Viz::kScene;
  writing.shape = colliders == nullptr ? kLiveShape : colliders->shape();
  if (colliders != nullptr) writing.owners = colliders->owners();
  if (limbs != nullptr && limbs->sphere_count() > 0) {
    writing.shape = ColliderShape::kSpheres;
    writing.owners = Owners::kPeople;
  }
  if (options.limits.sync) writing.sync = ChunkSync::kEach;
  if (options.live.is_live()) writing.chunk_s = kLiveChunk_s;
  return writing;
}

void record_scene(const RecordOptions& options, const std::vector<Person>& people, ColliderSource& colliders,
                  CarriedLimbs& limbs, const RecordingSettings& settings, Recorder& recorder) {
  std::optional<PlacementQuestion> question;
  if (options.scene.from_file() && people.size() == 1)
    question.emplace(people.front().scene.avatar, options.scene.convention.of_colliders(), settings.origin_m);
  std::vector<SampledPerson> sampled;
  sampled.reserve(people.size());
  for (const Person& person : people) sampled.push_back(person.sampled());
  const auto write = [&](TraceFrame& frame) {
    if (snapshot_wanted()) recorder.snapshot();
    if (question) question->see(frame);
    limbs.carry(frame);
    return recorder.write(frame);
  };
  {
    Progress progress("Recording", options.common.verbosity());
    record(write, sampled, colliders, settings, [&](double share) { return progress.update(share); });
  }
  if (!question) return;
  if (const auto doubt = question->ask())
    warn(fmt::format("--colliders {}: {}", options.scene.colliders, *doubt), options.common.verbosity());
}

std::string name_of(const std::vector<std::filesystem::path>& files) {
  if (files.size() == 1) return files.front().string();
  return fmt::format("{} to {}", files.front().string(), files.back().string());
}

/// Parts are named as they begin, which would be over the result.
void refuse_part_name(const RecordOptions& options, const RecordingLimits& limits) {
  const std::filesystem::path trace(options.output);
  const std::filesystem::path json(options.common.json);
  if ((!limits.splits() && !limits.ring_s) || json.empty()) return;
  if (!is_part_path(trace, json) && trace.filename() != json.filename()) return;
  std::error_code none;
  const auto folder_of = [&](const std::filesystem::path& path) {
    return std::filesystem::weakly_canonical(std::filesystem::absolute(path, none).parent_path(), none);
  };
  if (folder_of(trace) == folder_of(json))
    throw UsageError(options.common.json, "the recording, or a part of it, has this name", "choose another name");
}

/// Loads the avatars, maps and motions of all people.
std::vector<Person> load_people(const RecordOptions& options, const glm::dvec3& origin_m,
                                const std::vector<std::string>& outputs) {
  const Verbosity verbosity = options.common.verbosity();
  std::vector<Person> people;
  people.reserve(options.people.size());  // an animation belongs to its scene
  for (const PersonChoice& choice : options.people) {
    Person& person = people.emplace_back();
    person.scene = load_scene(choice.avatar, choice.map, choice.facing, verbosity);
    person.scene.name = choice.name;
    person.stance = stance_of(choice, person.scene.avatar);
    require_near(origin_m + person.stance.position_m, "--at", choice.at);
    if (options.live.is_live()) continue;
    load_motion(choice.animation, options.scene.motion, person.scene.avatar, outputs, options.common);
    person.animation = choose_animation(person.scene.avatar, choice.animation, options.scene.morphs, verbosity);
  }
  if (options.is_touch) let_touch(people);
  return people;
}

/// How a recording went.
struct RecordingResult {
  LiveCounts lost;
  double recording_s = 0;
};

/// Says what ended the recording early, and what it removed.
void warn_of_end(const RecordOptions& options, const RecordingLimits& limits, const Recorder& recorder) {
  const Verbosity verbosity = options.common.verbosity();
  const bool cut_short = interrupted() && !options.live.is_live();
  if (recorder.is_ring_cut_by_size())
    warn(fmt::format("--max-size {} holds less than {} s: the trace has only the last {}", options.limits.max_size,
                     *limits.ring_s, counted(recorder.frame_count(), "frame")),
         verbosity);
  if (cut_short && limits.ring_s)
    warn(fmt::format("stopped; the trace has the last {} before that", counted(recorder.frame_count(), "frame")),
         verbosity);
  else if (cut_short || recorder.is_full())
    warn(fmt::format("stopped {}after {}; the trace is complete up to there",
                     recorder.is_full() ? "by --max-size " : "", counted(recorder.frame_count(), "frame")),
         verbosity);
  if (!recorder.removed().empty())
    warn(fmt::format("removed the earlier recording's {}", name_of(recorder.removed())), verbosity);
}

/// Writes the JSON and prints the summary.
void report(const RecordOptions& options, const std::vector<Person>& people, const Recorder& recorder,
            const RecordingResult& result, const Invocation& invocation) {
  nlohmann::ordered_json json = provenance(invocation.argv);
  json["trace"] = options.output;
  json["files"] = recorder.files();
  json["removed"] = recorder.removed();
  json["frames"] = recorder.frame_count();
  json["recording_s"] = result.recording_s;
  json["bytes"] = recorder.bytes_written();
  if (options.live.is_live()) {
    json["lost"] = {
        {"late", result.lost.late}, {"malformed", result.lost.malformed}, {"overflowed", result.lost.overflowed}};
    if (people.size() > 1) json["lost"]["ids_clash"] = result.lost.ids_clash;
  }
  json["avatar"] = to_json(people.front().scene.avatar);
  if (people.size() > 1)
    for (const Person& person : people) {
      json["avatars"].push_back(to_json(person.scene.avatar));
      json["avatars"].back()["name"] = person.scene.name;
    }
  write_json(options.common.json, json, options.common);
  const std::string rate = options.live.is_lines() ? "" : fmt::format(" at {} Hz", options.recording.rate_hz);
  const std::string who = people.size() == 1 ? "" : fmt::format(" of {}", count_of_people(people.size()));
  print_summary(
      fmt::format("{}: {}{}{}, {:.1f} MB\n", name_of(recorder.files()), counted(recorder.frame_count(), "frame"), who,
                  rate, static_cast<double>(recorder.bytes_written()) / 1e6),
      {options.output, options.common.json}, options.common);
}

void run_record(const RecordOptions& options, Invocation& invocation) {
  const Verbosity verbosity = options.common.verbosity();
  check_trace_name(options.output);
  const RecordingSettings settings = settings_of(options);
  const RecordingLimits limits = limits_of(options.limits, options.output);
  const std::vector<std::string> outputs = {limits.splits() ? part_path(options.output, 1).string() : options.output,
                                            options.common.json};
  std::vector<std::string> inputs = {options.scene.colliders};
  for (const PersonChoice& person : options.people)
    inputs.insert(inputs.end(), {person.avatar, person.map, sidecar_path(person.map).string(), person.animation});
  check_outputs(outputs, inputs, options.common);
  refuse_part_name(options, limits);
  if (options.output == "-") refuse_terminal("-o -");

  const std::vector<Person> people = load_people(options, settings.origin_m, outputs);
  std::unique_ptr<ColliderSource> colliders;
  std::optional<CarriedLimbs> limbs;
  if (options.live.is_live()) {
    limbs = limbs_of(options.people, people, kFirstLiveLimb);
  } else {
    warn_of_overlap(people, verbosity);
    colliders = make_colliders(options.scene, people, options.common.seed);
    limbs = limbs_of(options.people, people, first_limb_id(options.scene, *colliders, people.size()));
    check_colliders(options.scene, *colliders, options.recording.duration_s, verbosity);
    if (const std::string how = describe_resampling(colliders->median_step_s(), settings.rate_hz); !how.empty())
      warn(fmt::format("--colliders {}: {}", options.scene.colliders, how), verbosity);
  }

  const double frames = settings.rate_hz * settings.duration_s;
  if (!options.live.is_live())
    warn_of_frame_count(frames, "Ctrl-C ends the recording early, with a complete trace up to then", verbosity);
  catch_interrupts();
  catch_snapshots(limits.ring_s && options.output != "-" ? Snapshots::kWanted : Snapshots::kIgnored);
  const auto start = std::chrono::steady_clock::now();
  Recorder recorder({.path = options.output,
                     .session = session_of(options, people, invocation),
                     .people = recorded_people(people),
                     .writing = writing_of(options, colliders.get(), limbs ? &*limbs : nullptr),
                     .limits = limits,
                     .snapshot_written = snapshot_teller(verbosity)});
  RecordingResult result;
  if (options.live.is_live()) {
    const auto duration_s = options.has_duration ? std::optional(settings.duration_s) : std::nullopt;
    LiveSettings live = {.rate_hz = settings.rate_hz, .duration_s = duration_s};
    if (limbs->sphere_count() > 0) live.complete = [&](TraceFrame& frame) { limbs->carry(frame); };
    std::vector<LivePerson> live_people;
    live_people.reserve(people.size());
    for (const Person& person : people) live_people.push_back({person.scene.avatar, person.stance});
    result.lost = record_live(options.live, live_people, recorder, live, settings.origin_m, verbosity);
  } else {
    record_scene(options, people, *colliders, *limbs, settings, recorder);
  }
  recorder.finish();
  result.recording_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  warn_of_end(options, limits, recorder);
  // What came in live and found no room cannot be made again.
  if (result.lost.lost_something() || (options.live.is_live() && recorder.is_full())) invocation.exit_code = kDataLost;
  report(options, people, recorder, result, invocation);
}

}  // namespace

void add_record(CLI::App& program, Invocation& invocation) {
  auto options = std::make_shared<RecordOptions>();
  CLI::App* verb = add_verb(program, "record", "Write a trace of an avatar and the colliders around it",
                            "  vestige record -o man.mcap\n"
                            "  vestige record --avatar man.glb --map regions.png --count 40 --rate 500 -o man.mcap\n");
  add_scene_options(*verb, options->scene);
  add_live_options(*verb);
  add_people_options(*verb);
  CLI::Option* colliders = verb->get_option("--colliders");
  std::string description = colliders->get_description();
  description.insert(description.find(fmt::format("\n  {}", kNoColliders)),
                     fmt::format("\n  {} two people, one of whom pats the other's shoulder", kTouch));
  colliders->description(description);
  verb->add_option("--rate", options->recording.rate_hz, "Frames per second")
      ->type_name("HZ")
      ->capture_default_str()
      ->check(help::between(help::kLeastRate_hz, help::kMostRate_hz));
  verb->add_option("--duration", options->recording.duration_s,
                   "How long the scene lasts, in seconds. Without this flag, a live recording lasts until the end of "
                   "its input or Ctrl-C. With datagrams, the time counts from the first one")
      ->type_name("S")
      ->capture_default_str()
      ->check(help::kPositive);
  add_limits_options(*verb, options->limits);
  verb->add_option("--origin", options->origin, "Where in the world the scene stands, in metres")
      ->capture_default_str()
      ->type_name("X,Y,Z");
  verb->add_option("--compression", options->compression, "How the trace's chunks are compressed")
      ->capture_default_str()
      ->check(CLI::IsMember({"zstd", "lz4", "none"}));
  verb->add_flag("--viz", options->viz,
                 "Add /viz/tf and /viz/scene, 60 times a second, so that Foxglove and Lichtblick draw skeleton and "
                 "colliders; 'vestige viz' adds contacts, duties and skin afterwards");
  verb->add_option("-o,--output", options->output, "The trace to write, or '-' for standard output")
      ->required()
      ->type_name("OUT.mcap|-");
  add_common_options(*verb, options->common);
  verb->callback([options, verb, &invocation] {
    options->people = people_choices(*verb);
    std::vector<std::string> animations;
    for (const PersonChoice& person : options->people) animations.push_back(person.animation);
    const bool has_limbs =
        std::ranges::any_of(options->people, [](const PersonChoice& person) { return !person.limbs.empty(); });
    options->is_touch = options->scene.colliders == kTouch;
    if (options->is_touch || (has_limbs && verb->count("--colliders") == 0)) options->scene.colliders = kNoColliders;
    check_scene_choice(options->scene, animations);
    if (std::ranges::any_of(options->people, [](const PersonChoice& person) { return !person.live.empty(); }))
      for (const PersonChoice& person : options->people) options->live.sources.push_back(person.live);
    check_live_choice(*verb, options->live);
    options->has_duration = verb->count("--duration") != 0;
    run_record(*options, invocation);
  });
}

}  // namespace vestige::cli
