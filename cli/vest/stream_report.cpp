#include "cli/vest/stream_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "analysis/base/provenance.hpp"
#include "traces/base/number_text.hpp"

namespace vestige::cli {

nlohmann::ordered_json to_json(const LatencyHistogram& latency) {
  return {{"p50", latency.quantile_us(0.5)},
          {"p95", latency.quantile_us(0.95)},
          {"p99", latency.quantile_us(0.99)},
          {"max", latency.max_us()}};
}

std::string describe(const LatencyHistogram& latency) {
  return fmt::format("p50 {:.2f}, p95 {:.2f}, p99 {:.2f}, max {:.2f} ms", latency.quantile_us(0.5) / 1e3,
                     latency.quantile_us(0.95) / 1e3, latency.quantile_us(0.99) / 1e3, latency.max_us() / 1e3);
}

namespace {

/// What was sent to all vests together.
SenderStatistics total_of(const std::vector<std::unique_ptr<Wearer>>& wearers) {
  SenderStatistics total = wearers.front()->sent();
  for (auto wearer = wearers.begin() + 1; wearer != wearers.end(); ++wearer) total += (*wearer)->sent();
  return total;
}

std::uint64_t contacts_of(const PlaybackResult& playback) {
  std::uint64_t contacts = 0;
  for (const PlaybackResult::Person& person : playback.people) contacts += person.contacts;
  return contacts;
}

void add_to(nlohmann::ordered_json& json, const SenderStatistics& sender, std::uint64_t maps_reloaded) {
  json["sent"] = sender.sent;
  json["changes"] = sender.changes;
  json["superseded"] = sender.superseded;
  json["acknowledged"] = sender.acknowledged;
  json["off_sent"] = sender.off_sent;
  json["off_acknowledged"] = sender.off_acknowledged;
  json["zeros_acknowledged"] = sender.zeros_acknowledged;
  json["most_unanswered"] = sender.most_unanswered;
  json["fail_safes"] = sender.fail_safes;
  json["output_failures"] = sender.output_failures;
  json["overruns"] = sender.overruns;
  json["receive_errors"] = sender.receive_errors;
  json["links_lost"] = sender.links_lost;
  json["maps_reloaded"] = maps_reloaded;
  json["latency_us"] = {{"written", to_json(sender.written)}, {"acknowledged", to_json(sender.acknowledged_after)}};
}

nlohmann::ordered_json link_of(const Wearer& wearer) {
  nlohmann::ordered_json link = wearer.sink().link_json();
  link["bytes"] = wearer.sent().bytes;
  return link;
}

/// Each person of the trace. Who wears no vest has no link.
nlohmann::ordered_json avatars_of(const Streamed& streamed) {
  nlohmann::ordered_json avatars = nlohmann::ordered_json::array();
  for (const TracedPerson& person : streamed.trace.people)
    avatars.push_back({{"name", person.name}, {"link", nullptr}});
  for (std::size_t i = 0; i < streamed.wearers.size(); ++i) {
    const Wearer& wearer = *streamed.wearers[i];
    nlohmann::ordered_json& json = avatars[wearer.number()];
    json.erase("link");
    json["law"] = wearer.laws().to_json();
    json["contacts"] = streamed.playback.people[i].contacts;
    add_to(json, wearer.sent(), wearer.maps_reloaded());
    json["link"] = link_of(wearer);
  }
  return avatars;
}

/// Returns what is known of the frames that switch everything off at the end.
const char* off_at_end(const SenderStatistics& sender, const ActuatorSink& sink) {
  if (doubt_about_off(sender, sink).empty()) return sink.acknowledges() ? "acknowledged" : "sent";
  return sender.zeros_acknowledged ? "all levels 0 acknowledged, OFF not" : "NOT CONFIRMED";
}

std::string summary_of(const Wearer& wearer) {
  const SenderStatistics& sender = wearer.sent();
  const OpenSink& sink = wearer.sink();
  std::string text = fmt::format("sent {} frames, {} of them changes; {} changes superseded by newer ones", sender.sent,
                                 sender.changes, sender.superseded);
  text += sink.sink().acknowledges() ? fmt::format("; {} acknowledged\n", sender.acknowledged) : "\n";
  if (sender.written.count() != 0) text += fmt::format("contact to last byte written: {}\n", describe(sender.written));
  if (sender.acknowledged_after.count() != 0)
    text += fmt::format("contact to acknowledgement:   {}\n", describe(sender.acknowledged_after));
  text += fmt::format("all actuators off at the end: {}\n", off_at_end(sender, sink.sink()));
  return text + sink.describe_link(sender.bytes);
}

/// What went wrong on the way to one vest.
int report_losses(const Wearer& wearer, const PlaybackResult::Person& person, Verbosity verbosity) {
  const SenderStatistics& sender = wearer.sent();
  const OpenSink& sink = wearer.sink();
  const std::string name = sink.sink().name();
  int code = sender.links_lost == 0 ? kDone : kDataLost;
  const auto say = [&](const std::string& text) {
    warn(name + ": " + text, verbosity);
    code = kDataLost;
  };
  if (person.non_finite_frames + person.non_finite_segments != 0)
    say(fmt::format("{} poses and the ends of {} segments are not finite; they fired nothing", person.non_finite_frames,
                    person.non_finite_segments));
  if (sender.receive_errors + sender.overruns != 0)
    say(fmt::format("the board counted {} damaged frames and lost bytes {} times; check the wires and the baud",
                    sender.receive_errors, sender.overruns));
  if (sender.output_failures != 0)
    say(
        fmt::format("the board's output chips did not answer it, by {}; all actuators were off meanwhile; check the "
                    "wires SDA and SCL, the chips' addresses and their supply",
                    counted(sender.output_failures, "answer")));
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

}  // namespace

nlohmann::ordered_json to_json(const Streamed& streamed, const Invocation& invocation) {
  const Wearer& first = *streamed.wearers.front();
  const Detector& detector = first.detector();
  const PlaybackResult& playback = streamed.playback;
  const SenderStatistics total = total_of(streamed.wearers);
  std::uint64_t maps_reloaded = 0;
  for (const auto& wearer : streamed.wearers) maps_reloaded += wearer->maps_reloaded();
  nlohmann::ordered_json json = provenance(invocation.argv);
  json["trace"] = streamed.options.trace;
  json["detector"] = detector.name();
  json["approximate"] = detector.is_approximate();
  if (const auto kept = detector.triangles_kept()) json["triangles_kept"] = *kept;
  json["law"] = first.laws().to_json();
  json["gl"] = vestige::to_json(detector.gl_info());
  json["frames"] = playback.frames;
  json["contacts"] = contacts_of(playback);
  json["loops"] = playback.loops;
  json["duration_s"] = playback.duration_s;
  json["missed_deadlines"] = playback.missed_deadlines;
  json["most_late_s"] = playback.most_late_s;
  json["floor_us"] = first.sink().floor().count();
  add_to(json, total, maps_reloaded);
  json["complete"] = (!interrupted() || streamed.options.playback.loop) && total.links_lost == 0;
  json["link"] = link_of(first);
  json["avatars"] = avatars_of(streamed);
  return json;
}

std::string summary(const Streamed& streamed) {
  const PlaybackResult& playback = streamed.playback;
  std::string text =
      fmt::format("{} in {:.2f} s, {}{}, {} missed{}\n", counted(playback.frames, "frame"), playback.duration_s,
                  counted(contacts_of(playback), "contact"),
                  streamed.wearers.front()->detector().is_approximate() ? " (approximate)" : "",
                  counted(playback.missed_deadlines, "deadline"),
                  playback.fell_behind() ? fmt::format(", up to {:.1f} s late", playback.most_late_s) : "");
  for (std::size_t i = 0; i < streamed.wearers.size(); ++i) {
    const Wearer& wearer = *streamed.wearers[i];
    if (streamed.trace.people.size() > 1)
      text += fmt::format("{}: {}\n", wearer.person().name, counted(playback.people[i].contacts, "contact"));
    text += summary_of(wearer);
  }
  return text;
}

int report_losses(const Streamed& streamed) {
  int code = kDone;
  for (std::size_t i = 0; i < streamed.wearers.size(); ++i)
    code = std::max(
        code, report_losses(*streamed.wearers[i], streamed.playback.people[i], streamed.options.common.verbosity()));
  return code;
}

}  // namespace vestige::cli
