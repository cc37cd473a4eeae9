#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "analysis/base/provenance.hpp"
#include "cli/choices/live_choice.hpp"
#include "cli/choices/scene.hpp"
#include "cli/choices/scene_choice.hpp"
#include "cli/choices/snapshots.hpp"
#include "cli/files/export_formats.hpp"
#include "cli/files/limits_choice.hpp"
#include "cli/help/validators.hpp"
#include "cli/verbs.hpp"
#include "traces/base/error.hpp"
#include "traces/base/number_text.hpp"
#include "traces/questions/placement_question.hpp"
#include "traces/recording/recorder.hpp"
#include "traces/recording/sampled_scene.hpp"
#include "traces/scene/colliders.hpp"

namespace vestige::cli {

namespace {

constexpr double kFarthest_m = 1e7;  // detector/CONTRACT.md, 2

/// When a live recording's chunks are closed, so that with the time until somebody looks nothing waits for 100 ms.
constexpr double kLiveChunk_s = 0.08;

/// A radius may come at any time.
constexpr ColliderShape kLiveShape = ColliderShape::kSpheres;

struct RecordOptions {
  CommonOptions common;
  SceneChoice scene;
  LimitsChoice limits;
  LiveChoice live;
  RecordingSettings recording;
  bool has_duration = false;
  std::string origin = "0,0,0";
  std::string compression = "zstd";
  bool viz = false;
  std::string output;
};

RecordingSettings settings_of(const RecordOptions& options) {
  RecordingSettings settings = options.recording;
  settings.origin_m = parse_vector(options.origin, "--origin");
  if (!options.live.is_lines())  // which have no rate
    refuse_too_many_frames(settings.rate_hz * settings.duration_s, "--duration", "lower --duration or --rate");
  if (std::max({std::abs(settings.origin_m.x), std::abs(settings.origin_m.y), std::abs(settings.origin_m.z)}) >
      kFarthest_m)
    throw UsageError("--origin", fmt::format("'{}' is farther away than 1e7 m", options.origin),
                     "choose a nearer origin: beyond 1e7 m, positions are too coarse for contacts");
  return settings;
}

Session session_of(const RecordOptions& options, const Animation* animation, const Invocation& invocation) {
  Session session = provenance_texts(invocation.argv);
  if (options.live.is_live()) {
    session["live"] = options.live.source;
    if (!options.live.is_lines()) session["rate_hz"] = fmt::format("{}", options.recording.rate_hz);
    return session;
  }
  session["rate_hz"] = fmt::format("{}", options.recording.rate_hz);
  session["animation"] = animation == nullptr ? "" : animation->name;
  session["colliders"] = options.scene.colliders;
  if (!options.scene.radius.text.empty()) session["radius"] = options.scene.radius.text;
  session["seed"] = fmt::format("{}", options.common.seed);
  if (options.scene.from_file()) note_collider_convention(options.scene.convention, session);
  return session;
}

TraceWriterOptions writing_of(const RecordOptions& options, ColliderShape shape) {
  TraceWriterOptions writing;
  writing.overwrite = options.common.overwrite();
  if (options.compression == "lz4") writing.compression = Compression::kLz4;
  if (options.compression == "none") writing.compression = Compression::kNone;
  if (options.viz) writing.viz = Viz::kScene;
  writing.shape = shape;
  if (options.limits.sync) writing.sync = ChunkSync::kEach;
  if (options.live.is_live()) writing.chunk_s = kLiveChunk_s;
  return writing;
}

void record_scene(const RecordOptions& options, const Scene& scene, const Animation* animation,
                  ColliderSource& colliders, const RecordingSettings& settings, Recorder& recorder) {
  std::optional<PlacementQuestion> question;
  if (options.scene.from_file())
    question.emplace(scene.avatar, options.scene.convention.of_colliders(), settings.origin_m);
  const auto write = [&](const TraceFrame& frame) {
    if (snapshot_wanted()) recorder.snapshot();
    if (question) question->see(frame);
    return recorder.write(frame);
  };
  {
    Progress progress("Recording", options.common.verbosity());
    record(write, scene.avatar, animation, colliders, settings, [&](double share) { return progress.update(share); });
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

void run_record(const RecordOptions& options, Invocation& invocation) {
  const Verbosity verbosity = options.common.verbosity();
  check_trace_name(options.output);
  const RecordingSettings settings = settings_of(options);
  const RecordingLimits limits = limits_of(options.limits, options.output);
  const std::vector<std::string> outputs = {limits.splits() ? part_path(options.output, 1).string() : options.output,
                                            options.common.json};
  check_outputs(outputs, {options.scene.avatar, options.scene.map, options.scene.colliders, options.scene.animation},
                options.common);
  refuse_part_name(options, limits);
  if (options.output == "-") refuse_terminal("-o -");

  Scene scene = load_scene(options.scene.avatar, options.scene.map, options.scene.facing, verbosity);
  const Animation* animation = nullptr;
  std::unique_ptr<ColliderSource> colliders;
  if (!options.live.is_live()) {
    load_motion(options.scene, scene.avatar, outputs, options.common);
    animation = choose_animation(scene.avatar, options.scene.animation, options.scene.morphs, verbosity);
    colliders = make_colliders(options.scene, scene.avatar, animation, options.common.seed);
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
                     .session = session_of(options, animation, invocation),
                     .avatar = scene.avatar,
                     .attachments = scene.attachments(),
                     .writing = writing_of(options, colliders ? colliders->shape() : kLiveShape),
                     .limits = limits});
  LiveCounts lost;
  if (options.live.is_live()) {
    const auto duration_s = options.has_duration ? std::optional(settings.duration_s) : std::nullopt;
    lost = record_live(options.live, scene, recorder, {.rate_hz = settings.rate_hz, .duration_s = duration_s},
                       settings.origin_m, verbosity);
  } else {
    record_scene(options, scene, animation, *colliders, settings, recorder);
  }
  recorder.finish();
  const std::chrono::duration<double> recording = std::chrono::steady_clock::now() - start;
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
  // What came in live and found no room cannot be made again.
  if (lost.lost_something() || (options.live.is_live() && recorder.is_full())) invocation.exit_code = kDataLost;

  if (!recorder.removed().empty())
    warn(fmt::format("removed the earlier recording's {}", name_of(recorder.removed())), verbosity);

  nlohmann::ordered_json json = provenance(invocation.argv);
  json["trace"] = options.output;
  json["files"] = recorder.files();
  json["removed"] = recorder.removed();
  json["frames"] = recorder.frame_count();
  json["recording_s"] = recording.count();
  json["bytes"] = recorder.bytes_written();
  if (options.live.is_live())
    json["lost"] = {{"late", lost.late}, {"malformed", lost.malformed}, {"overflowed", lost.overflowed}};
  json["avatar"] = to_json(scene.avatar);
  write_json(options.common.json, json, options.common);
  const std::string rate = options.live.is_lines() ? "" : fmt::format(" at {} Hz", settings.rate_hz);
  print_summary(
      fmt::format("{}: {}{}, {:.1f} MB\n", name_of(recorder.files()), counted(recorder.frame_count(), "frame"), rate,
                  static_cast<double>(recorder.bytes_written()) / 1e6),
      {options.output, options.common.json}, options.common);
}

}  // namespace

void add_record(CLI::App& program, Invocation& invocation) {
  auto options = std::make_shared<RecordOptions>();
  CLI::App* verb = add_verb(program, "record", "Write a trace of an avatar and the colliders around it",
                            "  vestige record -o man.mcap\n"
                            "  vestige record --avatar man.glb --map regions.png --count 40 --rate 500 -o man.mcap\n");
  add_scene_options(*verb, options->scene);
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
  add_live_options(*verb, options->live);
  verb->add_option("--origin", options->origin, "Where in the world the scene stands, in metres")
      ->capture_default_str()
      ->type_name("X,Y,Z");
  verb->add_option("--compression", options->compression, "How the trace's chunks are compressed")
      ->capture_default_str()
      ->check(CLI::IsMember({"zstd", "lz4", "none"}));
  verb->add_flag("--viz", options->viz,
                 "Add /viz/tf and /viz/scene, 60 times a second, so that Foxglove and Lichtblick draw skeleton and "
                 "colliders");
  verb->add_option("-o,--output", options->output, "The trace to write, or '-' for standard output")
      ->required()
      ->type_name("OUT.mcap|-");
  add_common_options(*verb, options->common);
  verb->callback([options, verb, &invocation] {
    check_scene_choice(options->scene);
    check_live_choice(*verb, options->live);
    options->has_duration = verb->count("--duration") != 0;
    run_record(*options, invocation);
  });
}

}  // namespace vestige::cli
