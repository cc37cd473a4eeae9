#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "analysis/run/playback.hpp"
#include "cli/choices/law_choice.hpp"
#include "cli/choices/person_maps.hpp"
#include "cli/choices/person_value.hpp"
#include "cli/choices/scene.hpp"
#include "cli/help/validators.hpp"
#include "cli/verbs.hpp"
#include "cli/vest/sink_choice.hpp"
#include "cli/vest/stream_report.hpp"
#include "cli/vest/vest_options.hpp"
#include "cli/vest/vests.hpp"
#include "cli/vest/vmc_stream.hpp"
#include "cli/vest/wearer.hpp"
#include "detector/detectors/path_choice.hpp"
#include "traces/base/error.hpp"
#include "traces/base/number_text.hpp"

namespace vestige::cli {

namespace {

/// Returns the name of the detector for all vests: what suits the finest avatar.
std::string detector_name(const StreamOptions& options, const std::vector<WornVest>& vests, OpenTrace& trace) {
  if (options.choice.detector != "auto") return options.choice.detector;
  std::size_t triangles = 0;
  for (const WornVest& vest : vests) triangles = std::max(triangles, trace.people[vest.person].avatar.triangles.size());
  return pick_path(triangles, trace.reader.collider_ids().size(), options.choice.skip_kind()).detector;
}

/// Plays the trace to those who wear vests.
PlaybackResult play_to(const Wearers& wearers, OpenTrace& trace, const std::string& detector,
                       const StreamOptions& options) {
  const Verbosity verbosity = options.common.verbosity();
  const auto tell = [verbosity](const std::string& text) { warn(text, verbosity); };
  for (const auto& wearer : wearers) wearer->open(tell);
  for (const auto& wearer : wearers) wearer->start(tell);
  const std::vector<DetectedPerson> people = detected_people(wearers);

  Progress progress("Streaming", verbosity);
  PlaybackCalls calls;
  calls.make_laws = [&] { return make_laws(wearers); };
  calls.go_on = [&](double share) {
    for (const auto& wearer : wearers) wearer->still_here(tell);
    return progress.update(share);
  };
  calls.fell_behind = [&] {
    tell(
        fmt::format("{}: the playback is a second late: '{}' does not keep up with the trace, or the machine was busy; "
                    "contacts are felt late and for longer\n  Use a faster --detector, or a lower --rate.",
                    options.trace, detector));
  };
  calls.take = [&](std::size_t i, const ActuatorFrame& frame, Sender::Clock::time_point due) {
    wearers[i]->take(frame, due);
  };
  PlaybackResult result = play(trace.reader, people, options.playback, calls);
  finish(wearers);
  commit(wearers);
  return result;
}

void run_stream(const StreamOptions& options, Invocation& invocation) {
  const Verbosity verbosity = options.common.verbosity();
  const std::vector<PersonValue> ports = parse_ports(options);
  if (options.plays_people()) return stream_people(options, ports, invocation);
  const std::vector<PersonValue> maps = parse_maps(options.maps);
  std::vector<std::string> outputs = {options.log, options.common.json};
  for (const PersonValue& port : ports) outputs.push_back(options.sink.at(port.value).output_path());
  std::vector<std::string> inputs = {options.trace, options.law.actuator};
  add_map_files(maps, inputs);
  check_outputs(outputs, inputs, options.common);
  check_vest_flags(options, maps);
  const std::vector<std::string> stamps = stamps_of(maps);

  OpenTrace trace(options.trace, verbosity, People::kSeveral);
  use_maps(maps, trace.people, options.trace, verbosity);
  const std::vector<WornVest> vests = vests_of(options, ports, maps, stamps, trace.people.size());
  for (auto vest = vests.begin() + 1; vest != vests.end(); ++vest) outputs.push_back(vest->log);
  check_outputs(outputs, inputs, options.common);  // again, with the logs of the other people
  require_frames(trace.reader, options.trace);
  const std::string name = detector_name(options, vests, trace);
  warn_of_radii({name}, trace.reader, options.trace, verbosity);
  require_spheres(std::span(&options.law.law, 1), trace.reader.has_spheres(), options.trace);
  SharedContext context(options.choice.context, options.choice.device);
  const Wearers wearers = make_wearers(options, vests, trace.people, name, context);

  catch_interrupts();
  Streamed streamed = {options, trace, wearers};
  streamed.playback = play_to(wearers, trace, name, options);

  print_summary(summary(streamed), outputs, options.common);
  write_json(options.common.json, to_json(streamed, invocation), options.common);
  const int losses = report_losses(streamed);
  const int damage = report_damage(trace.reader, options.trace, verbosity);
  const bool cut_short = interrupted() && !options.playback.loop;
  if (cut_short) warn("stopped after " + counted(streamed.playback.frames, "frame"), verbosity);
  invocation.exit_code =
      losses != kDone || damage != kDone || cut_short || streamed.playback.fell_behind() ? kDataLost : kDone;
}

}  // namespace

void add_stream(CLI::App& program, Invocation& invocation) {
  auto options = std::make_shared<StreamOptions>();
  CLI::App* verb = add_verb(program, "stream",
                            "Replay a trace in real time: drive a vest with it, or play its people to another program",
                            "  vestige stream man.mcap --port /dev/ttyUSB0\n"
                            "  vestige stream man.mcap --port vmc://127.0.0.1:39539 --rate 2\n");
  verb->add_option("TRACE", options->trace, "The trace, or '-' for standard input")->required();
  add_sinks_options(*verb, options->sink, options->ports,
                    ", by the speed at which a collider pushes into the skin, as a share of 1 m/s", VmcPorts::kTaken);
  const auto add_playing = [&](const char* name, auto& value, const char* description) {
    return verb->add_option(name, value, description)->group("Playing");
  };
  add_playing("--rate", options->playback.rate, "How fast the trace plays: 2 is twice as fast as it was recorded")
      ->capture_default_str()
      ->check(help::between(1e-3, 1e3))
      ->type_name("X");
  verb->add_flag("--loop", options->playback.loop, "Begin again at the trace's end, until Ctrl-C")->group("Playing");
  add_playing("--map", options->maps,
              "Use this actuator map instead of the trace's, and read it again whenever it changes on disk; of several "
              "people, that of person K")
      ->type_name("[K=]builtin|LAYOUT|FILE.png")
      ->expected(1)
      ->take_all();
  add_law_options(*verb, options->law, "Intensity", "; --rate does not change it");
  add_detector_and_context(*verb, options->choice);
  add_detector_options(*verb, options->choice);
  verb->add_option("--log", options->log,
                   "Write every changed state: its due time, whether it was sent or superseded, after how many "
                   "microseconds, and its levels; with several vests, OUT.csv is the first one's, and that of any "
                   "other person K "
                   "OUT.K.csv")
      ->group("Results")
      ->type_name("OUT.csv|-");
  add_common_options(*verb, options->common);
  verb->callback([options, &invocation] {
    options->scene = options->trace;
    options->law_rate = options->playback.rate;
    run_stream(*options, invocation);
  });
}

}  // namespace vestige::cli
