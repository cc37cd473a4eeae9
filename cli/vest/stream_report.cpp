#include "cli/vest/stream_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "analysis/base/provenance.hpp"
#include "cli/vest/wearer_report.hpp"
#include "traces/base/number_text.hpp"

namespace vestige::cli {

namespace {

std::uint64_t contacts_of(const PlaybackResult& playback) {
  std::uint64_t contacts = 0;
  for (const FeltPerson& person : playback.people) contacts += person.contacts;
  return contacts;
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
    text += summary_of(wearer, "contact");
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
