#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "analysis/base/provenance.hpp"
#include "analysis/live/datagram_input.hpp"
#include "analysis/live/line_input.hpp"
#include "analysis/live/live_run.hpp"
#include "analysis/live/realtime.hpp"
#include "cli/choices/law_choice.hpp"
#include "cli/choices/person_maps.hpp"
#include "cli/choices/person_value.hpp"
#include "cli/choices/scene.hpp"
#include "cli/choices/snapshots.hpp"
#include "cli/help/validators.hpp"
#include "cli/verbs.hpp"
#include "cli/vest/live_recorder.hpp"
#include "cli/vest/live_report.hpp"
#include "cli/vest/sink_choice.hpp"
#include "cli/vest/vests.hpp"
#include "traces/base/error.hpp"
#include "traces/base/host_port.hpp"
#include "traces/scene/people.hpp"
#include "traces/trace_file/trace_format.hpp"

namespace vestige::cli {

namespace {

constexpr PersonFlag kFromFlag = {"--from", "source", "vmc://0.0.0.0:39539"};
constexpr PersonFlag kAvatarFlag = {"--avatar", "avatar", "FILE.vrm"};
constexpr const char* kStandardInput = "-";

/// How often chunks of a recording are closed, so that with the time until somebody looks nothing waits for 100 ms.
constexpr double kRecordedChunk_s = 0.08;

/// What is known of a live session before it begins.
struct LivePlan {
  std::vector<std::string> sources;  ///< of each person, in order
  std::vector<std::string> avatars;  ///< likewise
  std::vector<PersonValue> ports;
  std::vector<PersonValue> maps;
  std::vector<std::string> stamps;  ///< of the maps
  std::vector<std::string> outputs;
  RecordingLimits limits;

  bool is_lines() const { return sources.front() == kStandardInput; }
};

/// OSC is what VMC is made of, so both schemes mean the same.
HostPort place_of(const std::string& source) {
  if (!source.starts_with("vmc://") && !source.starts_with("osc://"))
    throw UsageError(kFromFlag.name, fmt::format("'{}' begins with neither vmc:// nor osc://", source),
                     "name a host and a port: vmc://0.0.0.0:39539; or write -, for lines of JSON on standard input");
  return parse_host_port(source, source.starts_with("osc:") ? "osc" : "vmc", kFromFlag.name);
}

std::vector<std::string> sources_of(const LiveVerbOptions& options) {
  const std::vector<PersonValue> values = parse_person_values(kFromFlag, options.sources);
  std::vector<std::string> sources(values.size());
  std::set<std::string> taken;
  for (const PersonValue& value : values) {
    const std::size_t person = value.person.value_or(0);
    if (person >= sources.size())
      throw UsageError(kFromFlag.name,
                       fmt::format("person {} has a source, and there are sources for {}", value.number,
                                   count_of_people(sources.size())),
                       "number people from 1 up: --from 1=URL --from 2=URL");
    if (value.value == kStandardInput && sources.size() > 1)
      throw UsageError(kFromFlag.name, "lines on standard input are of one person",
                       "name ports: --from 1=vmc://HOST:PORT --from 2=vmc://HOST:PORT");
    if (value.value != kStandardInput && !taken.insert(host_port_url("vmc", place_of(value.value))).second)
      throw UsageError(kFromFlag.name, fmt::format("two people have the source {}", value.value),
                       "give each a port of their own");
    sources[person] = value.value;
  }
  if (sources.size() > trace_format::kMostPeople)
    throw UsageError(kFromFlag.name, fmt::format("there cannot be {} people", sources.size()),
                     fmt::format("choose at most {}", trace_format::kMostPeople));
  return sources;
}

void check_live_flags(const CLI::App& verb, const LiveVerbOptions& options, const LivePlan& plan) {
  if (plan.is_lines())
    for (const char* flag : {"--rate", "--pose"})
      if (verb.count(flag) != 0)
        throw UsageError(flag, "each line on standard input is a frame, with its pose",
                         fmt::format("leave {} out", flag));
  if (options.record == "-")
    throw UsageError("--record", "a live session is not recorded to standard output", "name a file: --record OUT.mcap");
  if (!options.record.empty()) return;
  for (const char* flag : {"--ring", "--max-size", "--split", "--sync"})
    if (verb.count(flag) != 0)
      throw UsageError(flag, "says how to record, and nothing is recorded", "name a file: --record OUT.mcap");
}

LivePlan plan_of(const CLI::App& verb, LiveVerbOptions& options) {
  LivePlan plan;
  plan.sources = sources_of(options);
  const std::size_t people = plan.sources.size();
  plan.avatars.assign(people, "builtin");
  options.scene = plan.is_lines() ? "standard input" : fmt::format("{}", fmt::join(options.sources, ", "));
  for (const PersonValue& avatar : parse_person_values(kAvatarFlag, options.avatars))
    plan.avatars[person_of(avatar, kAvatarFlag, people, options.scene)] = avatar.value;
  plan.ports = parse_ports(options);
  plan.maps = parse_maps(options.maps);
  check_live_flags(verb, options, plan);
  check_vest_flags(options, plan.maps);
  plan.stamps = stamps_of(plan.maps);
  plan.limits = limits_of(options.limits, options.record);
  const std::string recorded = plan.limits.splits() ? part_path(options.record, 1).string() : options.record;
  plan.outputs = {options.log, options.common.json, recorded};
  for (const PersonValue& port : plan.ports) plan.outputs.push_back(options.sink.at(port.value).output_path());
  return plan;
}

/// The people of a live session: who can be felt, and what a recording needs of them.
struct LivePeople {
  std::vector<Scene> scenes;         ///< without their avatars and maps
  std::vector<TracedPerson> people;  ///< with them
};

LivePeople load_people(const LivePlan& plan, const LiveVerbOptions& options) {
  LivePeople loaded;
  std::vector<std::string> maps(plan.sources.size());
  for (const PersonValue& map : plan.maps) maps[map.person.value_or(0)] = map.value;
  for (std::size_t i = 0; i < plan.sources.size(); ++i) {
    Scene scene = load_scene(plan.avatars[i], maps[i], options.facing, options.common.verbosity());
    if (plan.sources.size() > 1) scene.name = fmt::format("person {}", i + 1);
    loaded.people.push_back({scene.name, std::move(scene.avatar), std::move(scene.map)});
    loaded.scenes.push_back(std::move(scene));
  }
  return loaded;
}

std::unique_ptr<LiveInput> open_input(const LivePlan& plan, const LiveVerbOptions& options,
                                      const std::vector<TracedPerson>& people) {
  if (plan.is_lines()) return std::make_unique<LineInput>(people.front().avatar, STDIN_FILENO);
  std::vector<LivePort> ports;
  ports.reserve(people.size());
  for (std::size_t i = 0; i < people.size(); ++i)
    ports.push_back({plan.sources[i], place_of(plan.sources[i]), people[i].avatar});
  return std::make_unique<DatagramInput>(ports, options.pose_shown(), std::chrono::milliseconds(options.sink.ttl_ms));
}

std::unique_ptr<LiveRecorder> open_recorder(const LivePlan& plan, const LiveVerbOptions& options,
                                            const LivePeople& loaded, const Invocation& invocation) {
  Session session = provenance_texts(invocation.argv);
  for (std::size_t i = 0; i < plan.sources.size(); ++i) session[trace_format::numbered("live", i)] = plan.sources[i];
  if (options.rate_hz) session["rate_hz"] = fmt::format("{}", *options.rate_hz);
  std::vector<TracePerson> people;
  people.reserve(loaded.people.size());
  for (std::size_t i = 0; i < loaded.people.size(); ++i) {
    const Scene& scene = loaded.scenes[i];
    people.push_back({loaded.people[i].avatar, {scene.avatar_glb, scene.map_png, scene.map_json}, scene.name});
  }
  TraceWriterOptions writing;
  writing.overwrite = options.common.overwrite();
  writing.shape = ColliderShape::kSpheres;  // a radius may come at any time
  writing.chunk_s = kRecordedChunk_s;
  if (options.limits.sync) writing.sync = ChunkSync::kEach;
  const Verbosity verbosity = options.common.verbosity();
  return std::make_unique<LiveRecorder>(Recorder::Target{.path = options.record,
                                                         .session = std::move(session),
                                                         .people = std::move(people),
                                                         .writing = writing,
                                                         .limits = plan.limits,
                                                         .snapshot_written = snapshot_teller(verbosity)},
                                        [verbosity](const std::string& text) { warn(text, verbosity); });
}

/// Lets the wearers feel what comes in, until the end.
void feel(LiveInput& input, LiveSession& session, LiveRecorder* recorder) {
  const LiveVerbOptions& options = session.options;
  const Verbosity verbosity = options.common.verbosity();
  const auto tell = [verbosity](const std::string& text) { warn(text, verbosity); };
  if (options.realtime) session.real_time = take_real_time();
  for (const auto& wearer : session.wearers) wearer->start(tell);
  if (session.real_time) {
    take_core(*session.real_time);
    for (const std::string& refused : session.real_time->refused) tell("--realtime: " + refused);
  }
  if (verbosity != Verbosity::kQuiet)
    print_message(fmt::format("vestige: {} {}; Ctrl-C ends the session\n",
                              options.sources.front() == kStandardInput ? "reading" : "listening on", options.scene));
  LiveCalls calls;
  calls.make_laws = [&] { return make_laws(session.wearers); };
  calls.take = [&](std::size_t i, const ActuatorFrame& frame, Sender::Clock::time_point due) {
    session.wearers[i]->take(frame, due);
  };
  calls.go_on = [&] {
    for (const auto& wearer : session.wearers) wearer->still_here(tell);
    if (recorder != nullptr && snapshot_wanted()) recorder->snapshot();
    return !interrupted();
  };
  calls.note = [&](const LiveMoments& moments) { session.latency.add(moments); };
  if (recorder != nullptr)
    calls.record = [&](const TraceFrame& frame, std::vector<RecordingNote> notes) {
      recorder->take(frame, std::move(notes));
    };
  calls.tell = tell;
  const LiveOptions live = {.rate_hz = options.rate_hz,
                            .ttl = std::chrono::milliseconds(options.sink.ttl_ms),
                            .duration_s = options.duration_s};
  session.result = run_live(input, detected_people(session.wearers), live, calls);
}

void require_frame(const LiveSession& session, const LivePlan& plan) {
  if (session.result.frames != 0) return;
  throw Error(session.options.scene, "no whole frame arrived, so nothing was felt",
              plan.is_lines() ? "give a line of JSON for each frame: see traces/FORMAT.md"
                              : "make the sender send to this machine and port, and check that no firewall blocks it");
}

void run_live_verb(const CLI::App& verb, LiveVerbOptions& options, Invocation& invocation) {
  LivePlan plan = plan_of(verb, options);
  std::vector<std::string> inputs = plan.avatars;
  inputs.push_back(options.law.actuator);
  add_map_files(plan.maps, inputs);
  check_outputs(plan.outputs, inputs, options.common);
  const std::vector<WornVest> vests = vests_of(options, plan.ports, plan.maps, plan.stamps, plan.sources.size());
  for (auto vest = vests.begin() + 1; vest != vests.end(); ++vest) plan.outputs.push_back(vest->log);
  check_outputs(plan.outputs, inputs, options.common);  // again, with the logs of the other people

  LivePeople loaded = load_people(plan, options);
  const std::string detector = options.choice.detector == "auto" ? "cpu" : options.choice.detector;
  SharedContext context(options.choice.context, options.choice.device);
  const Wearers wearers = make_wearers(options, vests, loaded.people, detector, context);
  const Verbosity verbosity = options.common.verbosity();
  catch_interrupts();
  catch_snapshots(plan.limits.ring_s ? Snapshots::kWanted : Snapshots::kIgnored);
  const std::unique_ptr<LiveInput> input = open_input(plan, options, loaded.people);
  std::unique_ptr<LiveRecorder> recorder;
  if (!options.record.empty()) recorder = open_recorder(plan, options, loaded, invocation);
  for (const auto& wearer : wearers) wearer->open([verbosity](const std::string& text) { warn(text, verbosity); });

  LiveSession session = {.options = options, .people = loaded.people, .wearers = wearers};
  feel(*input, session, recorder.get());
  finish(wearers);  // whatever came, the motors are off before anything can fail
  require_frame(session, plan);
  commit(wearers);
  if (recorder) recorder->finish(session.result.notes);
  session.recorder = recorder.get();
  write_json(options.common.json, to_json(session, invocation), options.common);
  print_summary(summary(session), plan.outputs, options.common);
  invocation.exit_code = report_losses(session);
}

void add_input_options(CLI::App& verb, LiveVerbOptions& options) {
  const auto add = [&](const char* name, auto& value, const char* description) {
    return verb.add_option(name, value, description)->group("Input");
  };
  add("--from", options.sources,
      "Where frames come from: the VMC protocol and colliders by OSC on a UDP port (vmc://0.0.0.0:39539), or lines of "
      "JSON on standard input (-); of several people, those of person K, with ports of their own")
      ->required()
      ->type_name("[K=]vmc://HOST:PORT|osc://HOST:PORT|-")
      ->expected(1)
      ->take_all();
  add("--avatar", options.avatars,
      "The avatar that is moved, a glTF or VRM file; of several people, that of person K [default: builtin]")
      ->type_name("[K=]builtin|FILE")
      ->expected(1)
      ->take_all();
  add_facing_option(verb, options.facing)->group("Input");
  add("--pose", options.pose,
      "How poses are shown that come slower than colliders. interpolate: one pose late, so that the body never jumps; "
      "latest: the newest at once")
      ->capture_default_str()
      ->check(CLI::IsMember({"interpolate", "latest"}));
  add("--rate", options.rate_hz,
      "Frames per second, made of the newest that came [default: a frame whenever one is whole]")
      ->type_name("HZ")
      ->check(help::between(help::kLeastRate_hz, help::kMostRate_hz));
  add("--duration", options.duration_s,
      "How long the session lasts from the first frame on, in seconds [default: until the input ends, or Ctrl-C]")
      ->type_name("S")
      ->check(help::kPositive);
}

}  // namespace

void add_live(CLI::App& program, Invocation& invocation) {
  auto options = std::make_shared<LiveVerbOptions>();
  options->choice.method = "ccd";  // the body moves, too
  CLI::App* verb =
      add_verb(program, "live", "Feel what a VR program sends, as it comes: from the tracker to the vest's motors",
               "  vestige live --from vmc://0.0.0.0:39539 --avatar man.glb --port /dev/ttyUSB0\n"
               "  vestige live --from - --port file:felt.bin --record felt.mcap <man.ndjson\n");
  add_input_options(*verb, *options);
  add_sinks_options(*verb, options->sink, options->ports, "", VmcPorts::kRefused);
  verb->add_option("--map", options->maps,
                   "The actuator map, read again whenever it changes on disk; of several people, that of person K "
                   "[default: builtin for the built-in avatar]")
      ->type_name("[K=]builtin|LAYOUT|FILE.png")
      ->group("Intensity")
      ->expected(1)
      ->take_all();
  add_law_options(*verb, options->law, "Intensity");
  add_detector_and_context(*verb, options->choice);
  add_detector_options(*verb, options->choice);
  verb->add_flag("--realtime", options->realtime,
                 "Take real-time scheduling, locked memory and a core, as far as the system allows, and say what it "
                 "does not")
      ->group("Results");
  verb->add_option("--record", options->record, "Record the frames that are felt to this trace")
      ->group("Results")
      ->type_name("OUT.mcap");
  add_limits_options(*verb, options->limits);
  verb->add_option("--log", options->log,
                   "Write every changed state: its time, whether it was sent or superseded, after how many "
                   "microseconds, and its levels; with several vests, OUT.csv is the first one's, and that of any "
                   "other person K OUT.K.csv")
      ->group("Results")
      ->type_name("OUT.csv|-");
  add_common_options(*verb, options->common);
  verb->callback([options, verb, &invocation] { run_live_verb(*verb, *options, invocation); });
}

}  // namespace vestige::cli
