#include "cli/vest/vmc_stream.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "analysis/base/provenance.hpp"
#include "analysis/run/frame_pace.hpp"
#include "cli/choices/scene.hpp"
#include "cli/vest/sink_choice.hpp"
#include "cli/vest/wearer_report.hpp"
#include "traces/base/error.hpp"
#include "traces/base/host_port.hpp"
#include "traces/base/number_text.hpp"
#include "transport/vmc/vmc_sender.hpp"

namespace vestige::cli {

namespace {

/// A person of the trace who is played to a port.
struct Player {
  std::size_t person = 0;  ///< from 0 on
  HostPort place;
  std::unique_ptr<VmcSender> sender = {};
};

using Players = std::vector<Player>;

Players players_of(const std::vector<PersonValue>& ports, const StreamOptions& options, const OpenTrace& trace) {
  Players players;
  for (const PersonValue& port : ports)
    players.push_back({person_of(port, kPortFlag, trace.people.size(), options.trace),
                       parse_host_port(port.value, SinkChoice::kVmcScheme, kPortFlag.name)});
  std::ranges::sort(players, {}, &Player::person);
  return players;
}

void open(Players& players, const StreamOptions& options, OpenTrace& trace) {
  const Verbosity verbosity = options.common.verbosity();
  std::optional<std::span<const std::uint32_t>> ids = trace.reader.collider_ids();
  for (Player& player : players) {
    const TracedPerson& person = trace.people[player.person];
    const std::string name = trace.people.size() == 1 ? options.trace : options.trace + ", " + person.name;
    // Receivers refuse an id that comes from two ports, so only the first one gets the colliders.
    player.sender = std::make_unique<VmcSender>(player.place, PlayedPerson{player.person, person.avatar, name},
                                                std::exchange(ids, std::nullopt),
                                                [verbosity](const std::string& text) { warn(text, verbosity); });
  }
  for (const Player& player : players)
    if (player.sender->is_refused())
      warn(fmt::format("{}: no program listens there now; frames are sent anyway", player.sender->name()), verbosity);
}

/// After an error, which tells more than one that may come of this.
void take_colliders_away(const Players& players) {
  try {
    players.front().sender->finish();
  } catch (const Error&) {
  }
}

FramePace play_to(const Players& players, const StreamOptions& options, OpenTrace& trace) {
  Progress progress("Streaming", options.common.verbosity());
  const FrameCalls calls = {
      .at_end = FrameCalls::AtEnd::kHoldTheLast,
      .begin_run =
          [&, is_first = true]() mutable {
            if (!std::exchange(is_first, false))
              for (const Player& player : players) player.sender->begin_run();
          },
      .go_on = [&](double share) { return progress.update(share); },
      .fell_behind =
          [&] {
            warn(
                fmt::format("{}: the playback is a second late: the machine was busy, or it cannot send so much\n  Use "
                            "a lower --rate.",
                            options.trace),
                options.common.verbosity());
          },
      .take =
          [&](const TraceFrame& frame, double time_s, FrameCalls::Clock::time_point due) {
            for (const Player& player : players) player.sender->send(frame, time_s, due);
          },
  };
  FramePace pace;
  try {
    pace = play_frames(trace.reader, options.playback, calls);
  } catch (const Error&) {
    take_colliders_away(players);
    throw;
  }
  players.front().sender->finish();
  return pace;
}

void add_to(nlohmann::ordered_json& json, const VmcStatistics& statistics) {
  json["sent"] = statistics.sent;
  json["unsent"] = statistics.unsent;
  json["links_lost"] = statistics.links_lost;
  json["poses_left_out"] = statistics.poses_left_out;
  json["deviation_m"] = statistics.deviation.most_m;
  json["latency_us"] = {{"written", to_json(statistics.written)}};
}

nlohmann::ordered_json link_of(const VmcSender& sender) {
  return {{"port", sender.name()}, {"datagrams", sender.datagrams_sent()}, {"bytes", sender.bytes_sent()}};
}

nlohmann::ordered_json to_json(const Players& players, const FramePace& pace, const StreamOptions& options,
                               const OpenTrace& trace, const Invocation& invocation) {
  nlohmann::ordered_json json = provenance(invocation.argv);
  json["trace"] = options.trace;
  json["frames"] = pace.frames;
  json["loops"] = pace.loops;
  json["duration_s"] = pace.duration_s;
  json["missed_deadlines"] = pace.missed_deadlines;
  json["most_late_s"] = pace.most_late_s;
  json["colliders_left_out"] = players.front().sender->colliders_left_out();
  VmcStatistics total;
  for (const Player& player : players) total += player.sender->statistics();
  add_to(json, total);
  json["complete"] = (!interrupted() || options.playback.loop) && total.unsent == 0;
  json["link"] = link_of(*players.front().sender);
  json["avatars"] = nlohmann::ordered_json::array();
  for (const TracedPerson& person : trace.people) json["avatars"].push_back({{"name", person.name}, {"link", nullptr}});
  for (const Player& player : players) {
    nlohmann::ordered_json& avatar = json["avatars"][player.person];
    add_to(avatar, player.sender->statistics());
    avatar["link"] = link_of(*player.sender);
  }
  return json;
}

std::string summary_of(const Player& player, const OpenTrace& trace) {
  const VmcSender& sender = *player.sender;
  const VmcStatistics& statistics = sender.statistics();
  const SkinDifference::Bound& most = statistics.deviation;
  const TracedPerson& person = trace.people[player.person];
  std::string text = fmt::format("{}: sent {}, {} bytes in {}\n", sender.name(), counted(statistics.sent, "frame"),
                                 sender.bytes_sent(), counted(sender.datagrams_sent(), "datagram"));
  if (statistics.written.count() != 0) text += "due to last byte written: " + describe(statistics.written) + "\n";
  if (most.most_m > VmcSender::kToldDeviation_m)
    text += fmt::format("the skin that was sent lies up to {:.1f} mm from the trace's, at joint '{}'\n",
                        most.most_m * 1e3, person.avatar.nodes[most.node].name);
  return before_person(trace, player.person) + text;
}

/// Returns whether something of the trace could not be sent. Warnings have said so.
bool lost_something(const Player& player) {
  const VmcStatistics& statistics = player.sender->statistics();
  return statistics.unsent != 0 || statistics.poses_left_out != 0 || player.sender->colliders_left_out() != 0 ||
         statistics.deviation.most_m > VmcSender::kToldDeviation_m;
}

}  // namespace

void stream_people(const StreamOptions& options, const std::vector<PersonValue>& ports, Invocation& invocation) {
  const Verbosity verbosity = options.common.verbosity();
  check_outputs({options.common.json}, {options.trace}, options.common);
  OpenTrace trace(options.trace, verbosity, People::kSeveral);
  Players players = players_of(ports, options, trace);
  require_frames(trace.reader, options.trace);
  catch_interrupts();
  open(players, options, trace);
  const FramePace pace = play_to(players, options, trace);

  std::string text = fmt::format("{} in {:.2f} s, {} missed{}\n", counted(pace.frames, "frame"), pace.duration_s,
                                 counted(pace.missed_deadlines, "deadline"),
                                 pace.fell_behind() ? fmt::format(", up to {:.1f} s late", pace.most_late_s) : "");
  for (const Player& player : players) text += summary_of(player, trace);
  print_summary(text, {options.common.json}, options.common);
  write_json(options.common.json, to_json(players, pace, options, trace, invocation), options.common);
  const bool is_damaged = report_damage(trace.reader, options.trace, verbosity) != kDone;
  const bool cut_short = interrupted() && !options.playback.loop;
  if (cut_short) warn(fmt::format("stopped after {}", counted(pace.frames, "frame")), verbosity);
  if (std::ranges::any_of(players, lost_something) || is_damaged || cut_short || pace.fell_behind())
    invocation.exit_code = kDataLost;
}

}  // namespace vestige::cli
