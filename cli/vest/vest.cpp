#include <fmt/format.h>

#include <chrono>
#include <memory>
#include <thread>

#include "analysis/base/provenance.hpp"
#include "cli/help/validators.hpp"
#include "cli/verbs.hpp"
#include "cli/vest/sink_choice.hpp"
#include "traces/base/error.hpp"
#include "traces/base/number_text.hpp"
#include "transport/sender.hpp"

namespace vestige::cli {

namespace {

constexpr std::size_t kDefaultActuators = 6;    // the paper's vest
constexpr std::size_t kBhapticsActuators = 40;  // both sides of a vest
constexpr std::chrono::milliseconds kPause(300);
constexpr std::chrono::seconds kPatience(3);

struct CheckOptions {
  CommonOptions common;
  SinkChoice sink;
  std::size_t actuators = 0;
  int level = 255;
  double on_s = 0.7;
};

/// Waits until the board has the state, so that the next does not supersede it on a busy line; false when it never
/// does.
bool wait_until_heard(Sender& sender) {
  const auto until = Sender::Clock::now() + kPatience;
  while (!sender.heard() && Sender::Clock::now() < until && !interrupted()) {
    sender.still_here();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return sender.heard();
}

/// Waits; false when the user pressed Ctrl-C.
bool rest(Sender& sender, std::chrono::duration<double> duration) {
  const auto until = Sender::Clock::now() + duration;
  while (Sender::Clock::now() < until && !interrupted()) {
    sender.still_here();
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return !interrupted();
}

struct Checked {
  SenderStatistics sent;
  std::size_t actuators = 0;  ///< that ran, the last perhaps not to its end
  bool stopped = false;       ///< by the user, before the last had run
};

/// Each actuator in turn; says which while it runs.
Checked run_in_turn(const OpenSink& sink, std::size_t actuators, const CheckOptions& options) {
  Sender sender(sink.sink(), {.floor = sink.floor(), .refresh = sink.refresh()},
                [&](const std::string& text) { warn(text, options.common.verbosity()); });
  ActuatorFrame frame;
  Checked checked;
  bool going = true;
  bool heard = sink.greeting().has_value();
  const auto show = [&] {
    sender.post(frame, Sender::Clock::now());
    if (heard) heard = wait_until_heard(sender);
  };
  for (std::size_t i = 0; i < actuators && going; ++i) {
    checked.actuators = i + 1;
    print_summary(fmt::format("actuator {} of {}\n", i + 1, actuators),
                  {options.common.json, options.sink.output_path()}, options.common);
    frame.duty.assign(actuators, 0);
    frame.duty[i] = static_cast<std::uint8_t>(options.level);
    show();
    going = rest(sender, std::chrono::duration<double>(options.on_s));
    frame.duty[i] = 0;
    show();
    going = going && rest(sender, kPause);
  }
  checked.stopped = !going;
  checked.sent = sender.finish();
  return checked;
}

void run_check(const CheckOptions& options, Invocation& invocation) {
  check_outputs({options.common.json, options.sink.output_path()}, {}, options.common);
  catch_interrupts();
  std::size_t actuators = options.actuators;
  if (actuators == 0) actuators = options.sink.is_bhaptics() ? kBhapticsActuators : kDefaultActuators;
  std::vector<std::string> names;
  for (std::size_t i = 1; i <= actuators; ++i) names.push_back(std::to_string(i));
  OpenSink sink(options.sink, names, options.common,
                options.actuators == 0 ? Driven::kAllOfTheBoard : Driven::kThoseNamed);
  if (options.actuators == 0 && sink.greeting()) actuators = sink.greeting()->actuator_count;
  sink.warn_of_actuators_beyond(actuators, options.common.verbosity());
  const Checked checked = run_in_turn(sink, actuators, options);
  const SenderStatistics& statistics = checked.sent;
  sink.commit();

  const bool acknowledges = sink.sink().acknowledges();
  const bool all_answered = statistics.acknowledged == statistics.sent && statistics.off_acknowledged;
  const bool all_sent = statistics.off_sent && (statistics.superseded == 0 || checked.stopped);
  const bool good = all_sent && statistics.links_lost == 0 && statistics.output_failures == 0 &&
                    (!acknowledges || (sink.greeting() && all_answered));
  std::string verdict = "sent " + counted(statistics.sent, "frame");
  if (acknowledges) verdict += fmt::format(", {} acknowledged", statistics.acknowledged);
  if (statistics.links_lost > 0)
    verdict += fmt::format(", the link was lost {}", counted(statistics.links_lost, "time"));
  if (statistics.output_failures > 0)
    verdict += fmt::format(", {} say that its output chips do not answer it", statistics.output_failures);
  if (statistics.superseded > 0) verdict += fmt::format(", {} could not be sent in time", statistics.superseded);
  if (const std::string doubt = doubt_about_off(statistics, sink.sink()); !doubt.empty()) verdict += "; " + doubt;
  if (checked.stopped) verdict += fmt::format("; stopped at actuator {} of {}", checked.actuators, actuators);
  if (!good) {
    verdict += ": THE VEST DOES NOT HEAR EVERYTHING";
    if (statistics.output_failures > 0) verdict += "; check SDA, SCL, the chips' addresses and their supply";
    if (sink.greeting() && statistics.acknowledged <= 2) verdict += "; check that the board takes these --levels";
    verdict += "\n";
  } else if (checked.stopped) {
    verdict += "\n";
  } else if (!acknowledges) {
    verdict += "; this --port gives no answers, so only what you felt counts\n";
  } else {
    verdict += fmt::format(", answers after {:.1f} ms (median): the vest hears everything\n",
                           statistics.acknowledged_after.quantile_us(0.5) / 1e3);
  }
  print_summary(verdict + sink.describe_link(statistics.bytes), {options.common.json, options.sink.output_path()},
                options.common);

  nlohmann::ordered_json json = provenance(invocation.argv);
  json["actuators"] = actuators;
  json["sent"] = statistics.sent;
  json["acknowledged"] = statistics.acknowledged;
  json["receive_errors"] = statistics.receive_errors;
  json["output_failures"] = statistics.output_failures;
  json["links_lost"] = statistics.links_lost;
  json["off_sent"] = statistics.off_sent;
  json["off_acknowledged"] = statistics.off_acknowledged;
  json["zeros_acknowledged"] = statistics.zeros_acknowledged;
  json["link"] = sink.link_json();
  json["link"]["bytes"] = statistics.bytes;
  json["good"] = good;
  write_json(options.common.json, json, options.common);
  if (!good) invocation.exit_code = kCheckFailed;
  if (checked.stopped) invocation.exit_code = kDataLost;
}

void add_check(CLI::App& vest, Invocation& invocation) {
  auto options = std::make_shared<CheckOptions>();
  CLI::App* verb = add_verb(vest, "check", "Ask the board who it is, then run each actuator in turn",
                            "  vestige vest check --port /dev/ttyUSB0\n"
                            "  vestige vest check --port osc://127.0.0.1:9000 --actuators 2\n");
  add_sink_options(*verb, options->sink);
  verb->add_option("--actuators", options->actuators,
                   "Number of actuators [default: as the board says; 40 for bhaptics://, otherwise 6]")
      ->check(help::whole_number(1, kMaxActuators))
      ->type_name("N");
  verb->add_option("--level", options->level, "How strongly the actuators run")
      ->capture_default_str()
      ->check(help::whole_number(1, 255));
  verb->add_option("--seconds", options->on_s, "How long each actuator runs")
      ->capture_default_str()
      ->check(help::between(0.05, 60))
      ->type_name("S");
  add_common_options(*verb, options->common);
  verb->callback([options, &invocation] { run_check(*options, invocation); });
}

}  // namespace

void add_vest(CLI::App& program, Invocation& invocation) {
  CLI::App* verb = add_verb(program, "vest", "Try out a vest",
                            "  vestige vest check --port /dev/ttyUSB0\n"
                            "  vestige vest check --port /dev/ttyUSB0 --level 128 --seconds 2\n");
  verb->require_subcommand(1);
  add_check(*verb, invocation);
}

}  // namespace vestige::cli
