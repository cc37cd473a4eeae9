#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "analysis/provenance.hpp"
#include "cli/help/suggest.hpp"
#include "cli/help/validators.hpp"
#include "cli/scene.hpp"
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
  std::string avatar = "builtin";
  std::string animation;
  std::string map;
  std::string colliders = "swarm";
  std::optional<std::uint32_t> count;  ///< of a scenario; none: what it has by default
  RecordingSettings recording;
  std::string origin = "0,0,0";
  std::string compression = "zstd";
  std::string output;
};

UsageError no_scenario(const std::string& name) {
  std::vector<std::string_view> names;
  for (const Scenario& scenario : scenarios()) names.push_back(scenario.name);
  return {"--colliders", fmt::format("there is no scenario '{}'", name),
          fmt::format("{}the scenarios are: {}; or name a .csv file", help::did_you_mean(name, names),
                      fmt::join(names, ", "))};
}

bool is_file(const std::string& colliders) {
  return colliders.ends_with(".csv");
}

std::unique_ptr<ColliderSource> make_colliders(const RecordOptions& options, const Avatar& avatar,
                                               const Animation* animation) {
  if (is_file(options.colliders)) return read_collider_csv(options.colliders);
  const Scenario& scenario = *find_scenario(options.colliders);
  return scenario.make(avatar, animation, {options.count.value_or(scenario.default_count), options.common.seed});
}

std::string describe_colliders() {
  std::string text = "Where the colliders come from:";
  for (const Scenario& scenario : scenarios())
    fmt::format_to(std::back_inserter(text), "\n  {:<6} {}", scenario.name, scenario.summary);
  return text + "\nor a file of rows time_s,id,x,y,z";
}

std::string describe_count() {
  std::string text = fmt::format("Colliders of a scenario [default: {}", scenarios().front().default_count);
  for (const Scenario& scenario : scenarios())
    if (scenario.default_count != scenarios().front().default_count)
      fmt::format_to(std::back_inserter(text), "; {}: {}", scenario.name, scenario.default_count);
  return text + "]";
}

/// Samples of a file that the recording does not reach are said, and when it reaches none it is refused.
void check_span(const TimeSpan& span, const RecordOptions& options, Verbosity verbosity) {
  const std::string times = fmt::format("its samples lie from {} s to {} s, the recording from 0 s to {} s",
                                        span.first_s, span.last_s, options.recording.duration_s);
  if (span.last_s < 0 || span.first_s > options.recording.duration_s)
    throw Error(options.colliders, "no sample lies within the recording: " + times,
                "let the file's time begin at 0, or raise --duration");
  if (std::isfinite(span.last_s) && (span.first_s < 0 || span.last_s > options.recording.duration_s))
    warn(fmt::format("{}: {}; the rest is left out (--duration)", options.colliders, times), verbosity);
}

void run_record(const RecordOptions& options, Invocation& invocation) {
  const Verbosity verbosity = options.common.verbosity();
  RecordingSettings settings = options.recording;
  settings.origin_m = parse_vector(options.origin, "--origin");
  if (settings.rate_hz * settings.duration_s > kMostFrames)
    throw UsageError("--duration", "a trace holds 4294967295 frames at most", "record less, or at a lower --rate");
  check_outputs({options.output, options.common.json}, {options.avatar, options.map, options.colliders},
                options.common);
  if (std::max({std::abs(settings.origin_m.x), std::abs(settings.origin_m.y), std::abs(settings.origin_m.z)}) >
      kFarthest_m)
    throw UsageError("--origin", fmt::format("'{}' is farther away than 1e7 m", options.origin),
                     "beyond that, positions are too coarse for contacts");
  if (options.output == "-") refuse_terminal("-o -");

  const Scene scene = load_scene(options.avatar, options.map, verbosity);
  const Animation* animation = find_animation(scene.avatar, options.animation);
  const auto colliders = make_colliders(options, scene.avatar, animation);
  check_span(colliders->span_s(), options, verbosity);
  for (const std::string& warning : colliders->warnings())
    warn(fmt::format("--colliders {}: {}", options.colliders, warning), verbosity);

  Session session;
  const nlohmann::ordered_json origin = provenance(invocation.argv);
  for (const auto& [key, value] : origin.items())
    session[key] = value.is_string() ? value.get<std::string>() : value.dump();
  session["rate_hz"] = fmt::format("{}", settings.rate_hz);
  session["animation"] = animation == nullptr ? "" : animation->name;
  session["colliders"] = options.colliders;
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
  verb->add_option("--avatar", options->avatar, "The avatar: the built-in one, or a glTF file (.glb, .gltf, .vrm)")
      ->capture_default_str()
      ->type_name("builtin|FILE");
  verb->add_option("--animation", options->animation,
                   "Its animation, looping: a name, an index, or none [default: the first]")
      ->type_name("NAME|INDEX|none");
  verb->add_option("--map", options->map,
                   "The actuator map: a greyscale PNG in UV space, whose FILE.json names the actuators if it exists "
                   "[default: builtin for the built-in avatar, else none]")
      ->type_name("builtin|none|FILE.png");
  verb->add_option("--colliders", options->colliders, describe_colliders())
      ->capture_default_str()
      ->type_name("SCENARIO|FILE.csv");
  verb->add_option("--count", options->count, describe_count())->check(help::whole_number(1, 1000000));
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
    if (!is_file(options->colliders) && find_scenario(options->colliders) == nullptr)
      throw no_scenario(options->colliders);
    if (options->count && is_file(options->colliders))
      throw UsageError("--count", "a file has the colliders that it has", "leave --count out");
    run_record(*options, invocation);
  });
}

}  // namespace vestige::cli
