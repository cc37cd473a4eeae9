#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>

#include "analysis/provenance.hpp"
#include "cli/help/validators.hpp"
#include "cli/scene.hpp"
#include "cli/scene_choice.hpp"
#include "cli/verbs.hpp"
#include "traces/colliders.hpp"
#include "traces/error.hpp"
#include "traces/recording.hpp"

namespace vestige::cli {

namespace {

constexpr double kMostFrames = 4294967295.0;  // a trace numbers its frames in 32 bits

constexpr double kFarthest_m = 1e7;  // detector/CONTRACT.md, 2

struct RecordOptions {
  CommonOptions common;
  SceneChoice scene;
  RecordingSettings recording;
  std::string origin = "0,0,0";
  std::string compression = "zstd";
  std::string output;
};

void run_record(const RecordOptions& options, Invocation& invocation) {
  const Verbosity verbosity = options.common.verbosity();
  RecordingSettings settings = options.recording;
  settings.origin_m = parse_vector(options.origin, "--origin");
  if (settings.rate_hz * settings.duration_s > kMostFrames)
    throw UsageError("--duration", "a trace holds 4294967295 frames at most", "record less, or at a lower --rate");
  check_outputs({options.output, options.common.json},
                {options.scene.avatar, options.scene.map, options.scene.colliders, options.scene.animation},
                options.common);
  if (std::max({std::abs(settings.origin_m.x), std::abs(settings.origin_m.y), std::abs(settings.origin_m.z)}) >
      kFarthest_m)
    throw UsageError("--origin", fmt::format("'{}' is farther away than 1e7 m", options.origin),
                     "beyond that, positions are too coarse for contacts");
  if (options.output == "-") refuse_terminal("-o -");

  Scene scene = load_scene(options.scene.avatar, options.scene.map, verbosity);
  load_motion(options.scene, scene.avatar, verbosity);
  const Animation* animation = find_animation(scene.avatar, options.scene.animation);
  const auto colliders = make_colliders(options.scene, scene.avatar, animation, options.common.seed);
  check_colliders(options.scene, *colliders, options.recording.duration_s, verbosity);

  Session session;
  const nlohmann::ordered_json origin = provenance(invocation.argv);
  for (const auto& [key, value] : origin.items())
    session[key] = value.is_string() ? value.get<std::string>() : value.dump();
  session["rate_hz"] = fmt::format("{}", settings.rate_hz);
  session["animation"] = animation == nullptr ? "" : animation->name;
  session["colliders"] = options.scene.colliders;
  session["seed"] = fmt::format("{}", options.common.seed);

  TraceWriterOptions writing;
  writing.overwrite = options.common.overwrite();
  if (options.compression == "lz4") writing.compression = Compression::kLz4;
  if (options.compression == "none") writing.compression = Compression::kNone;
  catch_interrupts();
  const auto start = std::chrono::steady_clock::now();
  TraceWriter writer(options.output, session, scene.avatar, scene.attachments(), writing);
  {
    Progress progress("Recording", verbosity);
    record(writer, scene.avatar, animation, *colliders, settings, [&](double share) { return progress.update(share); });
  }
  writer.finish();
  const std::chrono::duration<double> recording = std::chrono::steady_clock::now() - start;
  if (interrupted())
    warn(fmt::format("stopped after {} frames; the trace is complete up to there", writer.frame_count()), verbosity);

  nlohmann::ordered_json json = provenance(invocation.argv);
  json["trace"] = options.output;
  json["frames"] = writer.frame_count();
  json["recording_s"] = recording.count();
  json["bytes"] = writer.bytes_written();
  json["avatar"] = to_json(scene.avatar);
  write_json(options.common.json, json, options.common);
  print_summary(fmt::format("{}: {} frame{} at {} Hz, {:.1f} MB\n", options.output, writer.frame_count(),
                            writer.frame_count() == 1 ? "" : "s", settings.rate_hz,
                            static_cast<double>(writer.bytes_written()) / 1e6),
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
      ->check(help::kPositive);
  verb->add_option("--duration", options->recording.duration_s, "How long, in seconds")
      ->type_name("S")
      ->capture_default_str()
      ->check(help::kPositive);
  verb->add_option("--origin", options->origin, "Where in the world the scene stands, in metres")
      ->capture_default_str()
      ->type_name("X,Y,Z");
  verb->add_option("--compression", options->compression, "How the trace's chunks are compressed")
      ->capture_default_str()
      ->check(CLI::IsMember({"zstd", "lz4", "none"}));
  verb->add_option("-o,--output", options->output, "The trace to write, or '-' for standard output")
      ->required()
      ->type_name("OUT.mcap|-");
  add_common_options(*verb, options->common);
  verb->callback([options, &invocation] {
    check_scene_choice(options->scene);
    run_record(*options, invocation);
  });
}

}  // namespace vestige::cli
