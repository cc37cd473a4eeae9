#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "analysis/base/provenance.hpp"
#include "analysis/mapping/layouts.hpp"
#include "analysis/run/playback.hpp"
#include "cli/choices/detectors.hpp"
#include "cli/choices/law_choice.hpp"
#include "cli/choices/scene.hpp"
#include "cli/help/validators.hpp"
#include "cli/verbs.hpp"
#include "cli/vest/sink_choice.hpp"
#include "detector/actuators/actuator_map_watch.hpp"
#include "detector/detectors/path_choice.hpp"
#include "traces/base/error.hpp"
#include "traces/base/number_text.hpp"
#include "transport/sender.hpp"

namespace vestige::cli {

namespace {

struct StreamOptions {
  CommonOptions common;
  DetectorChoice choice;
  SinkChoice sink;
  PlaybackOptions playback;
  std::string trace;
  std::string map;
  LawFlags law;
  std::string log;

  /// Returns whether the map is a file that may change during the playback.
  bool is_map_watched() const { return !map.empty() && map != "builtin" && !is_layout(map); }
};

/// Writes what became of each changed state: `time_s,state,written_us,actuator_1,…`.
class StreamLog {
 public:
  StreamLog(const std::string& path, Overwrite overwrite, std::size_t actuator_count) : file_(path, overwrite) {
    std::string header = "time_s,state,written_us";
    for (std::size_t i = 1; i <= actuator_count; ++i) header += fmt::format(",actuator_{}", i);
    file_.write(header + "\n");
  }

  void write(const std::vector<SentState>& states) {
    for (const SentState& state : states) {
      const bool sent = state.fate == SentState::Fate::kSent;
      std::string line = fmt::format("{},{},{}", state.frame.time_s, sent ? "sent" : "superseded",
                                     sent ? fmt::format("{:.1f}", state.written_s * 1e6) : "");
      for (const std::uint8_t duty : state.frame.duty) line += fmt::format(",{}", duty);
      file_.write(line + "\n");
    }
  }

  void commit() { file_.commit(); }

 private:
  OutputFile file_;
};

/// A playback that has ended, and where it went.
struct Streamed {
  PlaybackResult playback;
  SenderStatistics sender;
  std::uint64_t maps_reloaded = 0;
};

nlohmann::ordered_json to_json(const LatencyHistogram& latency) {
  return {{"p50", latency.quantile_us(0.5)},
          {"p95", latency.quantile_us(0.95)},
          {"p99", latency.quantile_us(0.99)},
          {"max", latency.max_us()}};
}

nlohmann::ordered_json to_json(const Streamed& streamed, const StreamOptions& options, const OpenSink& sink,
                               const Detector& detector, const LawMaker& laws, const Invocation& invocation) {
  const SenderStatistics& sender = streamed.sender;
  nlohmann::ordered_json json = provenance(invocation.argv);
  json["trace"] = options.trace;
  json["detector"] = detector.name();
  json["approximate"] = detector.is_approximate();
  if (const auto kept = detector.triangles_kept()) json["triangles_kept"] = *kept;
  json["law"] = laws.to_json();
  json["gl"] = vestige::to_json(detector.gl_info());
  json["frames"] = streamed.playback.frames;
  json["contacts"] = streamed.playback.contacts;
  json["loops"] = streamed.playback.loops;
  json["duration_s"] = streamed.playback.duration_s;
  json["missed_deadlines"] = streamed.playback.missed_deadlines;
  json["most_late_s"] = streamed.playback.most_late_s;
  json["sent"] = sender.sent;
  json["changes"] = sender.changes;
  json["superseded"] = sender.superseded;
  json["acknowledged"] = sender.acknowledged;
  json["off_sent"] = sender.off_sent;
  json["off_acknowledged"] = sender.off_acknowledged;
  json["zeros_acknowledged"] = sender.zeros_acknowledged;
  json["most_unanswered"] = sender.most_unanswered;
  json["fail_safes"] = sender.fail_safes;
  json["overruns"] = sender.overruns;
  json["receive_errors"] = sender.receive_errors;
  json["links_lost"] = sender.links_lost;
  json["maps_reloaded"] = streamed.maps_reloaded;
  json["floor_us"] = SenderOptions().floor.count();
  json["latency_us"] = {{"written", to_json(sender.written)}, {"acknowledged", to_json(sender.acknowledged_after)}};
  json["complete"] = (!interrupted() || options.playback.loop) && sender.links_lost == 0;
  json["link"] = sink.link_json();
  json["link"]["bytes"] = sender.bytes;
  return json;
}

std::string describe(const LatencyHistogram& latency) {
  return fmt::format("p50 {:.2f}, p95 {:.2f}, p99 {:.2f}, max {:.2f} ms", latency.quantile_us(0.5) / 1e3,
                     latency.quantile_us(0.95) / 1e3, latency.quantile_us(0.99) / 1e3, latency.max_us() / 1e3);
}

/// Returns what is known of the frames that switch everything off at the end.
const char* off_at_end(const SenderStatistics& sender, const ActuatorSink& sink) {
  if (doubt_about_off(sender, sink).empty()) return sink.acknowledges() ? "acknowledged" : "sent";
  return sender.zeros_acknowledged ? "all levels 0 acknowledged, OFF not" : "NOT CONFIRMED";
}

std::string summary(const Streamed& streamed, const OpenSink& sink, const Detector& detector) {
  const PlaybackResult& playback = streamed.playback;
  const SenderStatistics& sender = streamed.sender;
  std::string text =
      fmt::format("{} in {:.2f} s, {}{}, {} missed{}\n", counted(playback.frames, "frame"), playback.duration_s,
                  counted(playback.contacts, "contact"), detector.is_approximate() ? " (approximate)" : "",
                  counted(playback.missed_deadlines, "deadline"),
                  playback.fell_behind() ? fmt::format(", up to {:.1f} s late", playback.most_late_s) : "");
  text += fmt::format("sent {} frames, {} of them changes; {} changes superseded by newer ones", sender.sent,
                      sender.changes, sender.superseded);
  text += sink.sink().acknowledges() ? fmt::format("; {} acknowledged\n", sender.acknowledged) : "\n";
  if (sender.written.count() != 0) text += fmt::format("contact to last byte written: {}\n", describe(sender.written));
  if (sender.acknowledged_after.count() != 0)
    text += fmt::format("contact to acknowledgement:   {}\n", describe(sender.acknowledged_after));
  text += fmt::format("all actuators off at the end: {}\n", off_at_end(sender, sink.sink()));
  return text + sink.describe_link(sender.bytes);
}

/// What went wrong on the way, to standard error; returns the exit code.
int report_losses(const Streamed& streamed, const OpenSink& sink, Verbosity verbosity) {
  const SenderStatistics& sender = streamed.sender;
  const PlaybackResult& playback = streamed.playback;
  const std::string name = sink.sink().name();
  int code = sender.links_lost == 0 ? kDone : kDataLost;
  const auto say = [&](const std::string& text) {
    warn(name + ": " + text, verbosity);
    code = kDataLost;
  };
  if (playback.non_finite_frames + playback.non_finite_segments != 0)
    say(fmt::format("{} poses and the ends of {} segments are not finite; they fired nothing",
                    playback.non_finite_frames, playback.non_finite_segments));
  if (sender.receive_errors + sender.overruns != 0)
    say(fmt::format("the board counted {} damaged frames and lost bytes {} times; check the wires and the baud",
                    sender.receive_errors, sender.overruns));
  if (sender.fail_safes != 0)
    say(fmt::format("the board switched itself off or restarted {} times", sender.fail_safes));
  if (const std::string radio = sink.radio_failure(); !radio.empty()) say(radio);
  const bool acknowledges = sink.sink().acknowledges();
  if (acknowledges && sender.acknowledged != sender.sent)
    say(fmt::format("{} of {} frames were not acknowledged{}", sender.sent - sender.acknowledged, sender.sent,
                    sink.greeting() && sender.acknowledged <= 2 ? "; check that the board takes these --levels" : ""));
  if (const std::string doubt = doubt_about_off(sender, sink.sink()); !doubt.empty()) say(doubt);
  return code;
}

void check_flags(const StreamOptions& options) {
  options.law.check();
  if (options.sink.quantity() == Quantity::kPressure && options.law.any())
    throw UsageError(options.law.actuator.empty() ? "--law" : "--actuator",
                     "pressures have their own law, which uses the speed of contacts", "leave it out");
  if (!options.map.empty() && options.choice.surface == "mapped")
    throw UsageError("--map", "may change during the playback, which --surface mapped cannot follow",
                     "leave one of the two out");
  if (options.map == "none")
    throw UsageError("--map", "'none' has no actuator to switch",
                     "name a map, or leave the flag out to use the trace's map");
  if (options.is_map_watched() && options.choice.detector == "paper")
    throw UsageError("--map", "may change during the playback, which --detector paper cannot follow",
                     "choose another detector");
}

/// Returns the warnings about the map of --map.
std::vector<std::string> map_warnings(const OpenTrace& trace, const StreamOptions& options) {
  std::vector<std::string> warnings = trace.person().map.warnings;
  std::string other =
      other_facing(trace.person().avatar.facing, trace.person().map.facing, {options.trace, options.map});
  if (!other.empty()) warnings.push_back(std::move(other));
  return warnings;
}

/// Puts the map of --map in the place of the trace's own, if one is named. Throws `Error` if there is no actuator.
void choose_map(OpenTrace& trace, const StreamOptions& options) {
  if (!options.map.empty()) {
    trace.person().map =
        parse_actuator_map(read_map_files(trace.person().avatar, options.map), trace.person().avatar, options.map);
    for (const std::string& warning : map_warnings(trace, options)) warn(warning, options.common.verbosity());
  }
  if (trace.person().map.actuator_count == 0)
    throw Error(options.map.empty() ? options.trace : options.map, "has no actuator, so nothing would be felt",
                "name a map that has actuators: --map FILE.png");
}

/// Returns laws for pressures if the sink asks for them, else those of --law.
LawMaker make_laws(const StreamOptions& options, const OpenTrace& trace) {
  const double rate = options.playback.rate;
  if (options.sink.quantity() == Quantity::kPressure) return {trace.person().map, options.law.options(rate).hold_s};
  return LawMaker(DriveMaker(options.law, trace.person().avatar, trace.person().map, rate));
}

void run_stream(const StreamOptions& options, Invocation& invocation) {
  const Verbosity verbosity = options.common.verbosity();
  const std::vector<std::string> outputs = {options.log, options.common.json, options.sink.output_path()};
  check_outputs(outputs, {options.trace, options.map, sidecar_path(options.map).string(), options.law.actuator},
                options.common);
  check_flags(options);
  const bool watched = options.is_map_watched();
  const std::string map_stamp = watched ? ActuatorMapWatch::stamp(options.map) : "";

  OpenTrace trace(options.trace, verbosity);
  choose_map(trace, options);
  const std::size_t actuator_count = trace.person().map.actuator_count;
  require_frames(trace.reader, options.trace);
  const std::size_t colliders = trace.reader.collider_ids().size();
  const std::string name =
      options.choice.detector == "auto"
          ? pick_path(trace.person().avatar.triangles.size(), colliders, options.choice.skip_kind()).detector
          : options.choice.detector;
  warn_of_radii({name}, trace.reader, options.trace, verbosity);
  require_spheres(std::span(&options.law.law, 1), trace.reader.has_spheres(), options.trace);
  LawMaker laws = make_laws(options, trace);
  const auto detector = make_detector(name, options.choice.context, options.choice, trace.person().avatar,
                                      trace.person().map, laws.planes());

  catch_interrupts();
  std::optional<StreamLog> log;
  if (!options.log.empty()) log.emplace(options.log, options.common.overwrite(), actuator_count);
  OpenSink sink(options.sink, trace.person().map.names, options.common);
  sink.warn_of_actuators_beyond(actuator_count, verbosity);
  const auto tell = [verbosity](const std::string& text) { warn(text, verbosity); };
  std::optional<ActuatorMapWatch> watch;
  if (watched)
    watch.emplace(options.map, map_stamp, actuator_count, trace.person().avatar,
                  laws.needs_layout() ? ActuatorMapWatch::Layouts::kMeasured : ActuatorMapWatch::Layouts::kNone, tell);

  Streamed streamed;
  {
    Sender sender(sink.sink(), {.keep_log = log.has_value()}, tell);
    Progress progress("Streaming", verbosity);
    PlaybackCalls calls;
    calls.make_law = [&] { return laws.make(); };
    calls.go_on = [&](double share) {
      if (auto taken = watch ? watch->take() : std::nullopt) {
        trace.person().map = std::move(taken->map);
        laws.use(trace.person().map, taken->layout);
        ++streamed.maps_reloaded;
        for (const std::string& warning : map_warnings(trace, options)) tell(warning);
      }
      sender.still_here();
      return progress.update(share);
    };
    calls.fell_behind = [&] {
      tell(fmt::format(
          "{}: the playback is a second late: '{}' does not keep up with the trace, or the machine was busy; "
          "contacts are felt late and for longer\n  Use a faster --detector, or a lower --rate.",
          options.trace, name));
    };
    calls.take = [&](const ActuatorFrame& frame, Sender::Clock::time_point due) {
      sender.post(frame, due);
      if (log) log->write(sender.take_log());
    };
    streamed.playback = play(trace.reader, trace.person().avatar, *detector, options.playback, calls);
    streamed.sender = sender.finish();
    if (log) log->write(sender.take_log());
  }
  sink.commit();
  if (log) log->commit();

  print_summary(summary(streamed, sink, *detector), outputs, options.common);
  write_json(options.common.json, to_json(streamed, options, sink, *detector, laws, invocation), options.common);
  const int losses = report_losses(streamed, sink, verbosity);
  const int damage = report_damage(trace.reader, options.trace, verbosity);
  const bool cut_short = interrupted() && !options.playback.loop;
  if (cut_short) warn(fmt::format("stopped after {} frames", streamed.playback.frames), verbosity);
  invocation.exit_code =
      losses != kDone || damage != kDone || cut_short || streamed.playback.fell_behind() ? kDataLost : kDone;
}

}  // namespace

void add_stream(CLI::App& program, Invocation& invocation) {
  auto options = std::make_shared<StreamOptions>();
  CLI::App* verb = add_verb(program, "stream", "Replay a trace in real time and drive a vest with it",
                            "  vestige stream man.mcap --port /dev/ttyUSB0\n"
                            "  vestige stream man.mcap --port osc://127.0.0.1:9000 --rate 2\n");
  verb->add_option("TRACE", options->trace, "The trace, or '-' for standard input")->required();
  add_sink_options(*verb, options->sink,
                   ", by the speed at which a collider pushes into the skin, as a share of 1 m/s");
  const auto add_playing = [&](const char* name, auto& value, const char* description) {
    return verb->add_option(name, value, description)->group("Playing");
  };
  add_playing("--rate", options->playback.rate, "How fast the trace plays: 2 is twice as fast as it was recorded")
      ->capture_default_str()
      ->check(help::between(1e-3, 1e3))
      ->type_name("X");
  verb->add_flag("--loop", options->playback.loop, "Begin again at the trace's end, until Ctrl-C")->group("Playing");
  add_playing("--map", options->map,
              "Use this actuator map instead of the trace's, and read it again whenever it changes on disk")
      ->type_name("builtin|LAYOUT|FILE.png");
  add_law_options(*verb, options->law, "Intensity", "; --rate does not change it");
  add_detector_and_context(*verb, options->choice);
  add_detector_options(*verb, options->choice);
  verb->add_option("--log", options->log,
                   "Write every changed state: its due time, whether it was sent or superseded, after how many "
                   "microseconds, and its levels")
      ->group("Results")
      ->type_name("OUT.csv|-");
  add_common_options(*verb, options->common);
  verb->callback([options, &invocation] { run_stream(*options, invocation); });
}

}  // namespace vestige::cli
