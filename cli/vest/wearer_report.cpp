#include "cli/vest/wearer_report.hpp"

#include <fmt/format.h>

#include "traces/base/number_text.hpp"

namespace vestige::cli {

namespace {

/// Returns what is known of the frames that switch everything off at the end.
const char* off_at_end(const SenderStatistics& sender, const ActuatorSink& sink) {
  if (doubt_about_off(sender, sink).empty()) return sink.acknowledges() ? "acknowledged" : "sent";
  return sender.zeros_acknowledged ? "all levels 0 acknowledged, OFF not" : "NOT CONFIRMED";
}

}  // namespace

nlohmann::ordered_json to_json(const LatencyHistogram& latency) {
  if (latency.count() == 0) return {{"p50", nullptr}, {"p95", nullptr}, {"p99", nullptr}, {"max", nullptr}};
  return {{"p50", latency.quantile_us(0.5)},
          {"p95", latency.quantile_us(0.95)},
          {"p99", latency.quantile_us(0.99)},
          {"max", latency.max_us()}};
}

std::string describe(const LatencyHistogram& latency) {
  return fmt::format("p50 {:.2f}, p95 {:.2f}, p99 {:.2f}, max {:.2f} ms", latency.quantile_us(0.5) / 1e3,
                     latency.quantile_us(0.95) / 1e3, latency.quantile_us(0.99) / 1e3, latency.max_us() / 1e3);
}

SenderStatistics total_of(const Wearers& wearers) {
  SenderStatistics total = wearers.front()->sent();
  for (auto wearer = wearers.begin() + 1; wearer != wearers.end(); ++wearer) total += (*wearer)->sent();
  return total;
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

std::string summary_of(const Wearer& wearer, std::string_view from) {
  const SenderStatistics& sender = wearer.sent();
  const OpenSink& sink = wearer.sink();
  std::string text = fmt::format("sent {}, {} of them changes; superseded by newer ones: {}",
                                 counted(sender.sent, "frame"), sender.changes, sender.superseded);
  text += sink.sink().acknowledges() ? fmt::format("; {} acknowledged\n", sender.acknowledged) : "\n";
  if (sender.written.count() != 0) text += fmt::format("{} to last byte written: {}\n", from, describe(sender.written));
  if (sender.acknowledged_after.count() != 0)
    text += fmt::format("{} to acknowledgement:   {}\n", from, describe(sender.acknowledged_after));
  text += fmt::format("all actuators off at the end: {}\n", off_at_end(sender, sink.sink()));
  return text + sink.describe_link(sender.bytes);
}

int report_losses(const Wearer& wearer, const FeltPerson& person, Verbosity verbosity) {
  const SenderStatistics& sender = wearer.sent();
  const OpenSink& sink = wearer.sink();
  const std::string name = sink.sink().name();
  int code = sender.links_lost == 0 ? kDone : kDataLost;
  const auto say = [&](const std::string& text) {
    warn(name + ": " + text, verbosity);
    code = kDataLost;
  };
  if (person.non_finite_frames + person.non_finite_segments != 0)
    say(fmt::format("{} and the ends of {} are not finite; they fired nothing",
                    counted(person.non_finite_frames, "pose"), counted(person.non_finite_segments, "segment")));
  if (sender.receive_errors + sender.overruns != 0)
    say(fmt::format("the board counted {} and lost bytes {}; check the wires and the baud",
                    counted(sender.receive_errors, "damaged frame"), counted(sender.overruns, "time")));
  if (sender.output_failures != 0)
    say(
        fmt::format("the board's output chips did not answer it, by {}; all actuators were off meanwhile; check the "
                    "wires SDA and SCL, the chips' addresses and their supply",
                    counted(sender.output_failures, "answer")));
  if (sender.fail_safes != 0)
    say(fmt::format("the board switched itself off or restarted {}", counted(sender.fail_safes, "time")));
  if (const std::string radio = sink.radio_failure(); !radio.empty()) say(radio);
  const bool acknowledges = sink.sink().acknowledges();
  if (acknowledges && sender.acknowledged != sender.sent)
    say(fmt::format("{} of {} frames were not acknowledged{}", sender.sent - sender.acknowledged, sender.sent,
                    sink.greeting() && sender.acknowledged <= 2 ? "; check that the board takes these --levels" : ""));
  if (const std::string doubt = doubt_about_off(sender, sink.sink()); !doubt.empty()) say(doubt);
  return code;
}

}  // namespace vestige::cli
