#include "cli/vest/live_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "analysis/base/clocks.hpp"
#include "analysis/base/provenance.hpp"
#include "cli/vest/wearer_report.hpp"
#include "detector/output/texture_hash.hpp"
#include "traces/base/number_text.hpp"

namespace vestige::cli {

void LiveLatency::add(const LiveMoments& moments) {
  decoded.add(seconds(moments.decoded - moments.arrived));
  detected.add(seconds(moments.detected - moments.arrived));
  pose_delay.add(moments.pose_delay_s);
  if (moments.interval_s) interval.add(*moments.interval_s);
}

namespace {

/// Quantiles and counts, in milliseconds.
nlohmann::ordered_json stage_json(const LatencyHistogram& latency) {
  nlohmann::ordered_json json;
  const nlohmann::ordered_json quantiles = to_json(latency);
  for (const auto& [name, us] : quantiles.items())
    json[name + "_ms"] = us.is_null() ? us : nlohmann::ordered_json(us.get<double>() / 1e3);
  json["count"] = latency.count();
  json["up_to_ms"] = nlohmann::ordered_json::array();
  json["counts"] = nlohmann::ordered_json::array();
  latency.for_each_class([&](double upper_us, std::uint64_t count) {
    json["up_to_ms"].push_back(upper_us / 1e3);
    json["counts"].push_back(count);
  });
  return json;
}

nlohmann::ordered_json latency_json(const LiveSession& session, const SenderStatistics& sent) {
  return {{"arrival_to_decoded", stage_json(session.latency.decoded)},
          {"arrival_to_detected", stage_json(session.latency.detected)},
          {"arrival_to_written", stage_json(sent.written)},
          {"arrival_to_acknowledged", stage_json(sent.acknowledged_after)},
          {"pose_delay", stage_json(session.latency.pose_delay)},
          {"frame_interval", stage_json(session.latency.interval)}};
}

nlohmann::ordered_json real_time_json(const std::optional<RealTime>& real_time) {
  nlohmann::ordered_json json = nullptr;
  if (!real_time) return json;
  json = {{"priority", nullptr}, {"memory_locked", real_time->memory_locked}, {"core", nullptr}};
  if (real_time->priority) json["priority"] = *real_time->priority;
  if (real_time->core) json["core"] = *real_time->core;
  json["refused"] = real_time->refused;
  return json;
}

std::uint64_t contacts_of(const LiveResult& result) {
  std::uint64_t contacts = 0;
  for (const FeltPerson& person : result.people) contacts += person.contacts;
  return contacts;
}

/// Each person of the scene. Who wears no vest has no link.
nlohmann::ordered_json avatars_of(const LiveSession& session) {
  nlohmann::ordered_json avatars = nlohmann::ordered_json::array();
  for (const TracedPerson& person : session.people) avatars.push_back({{"name", person.name}, {"link", nullptr}});
  for (std::size_t i = 0; i < session.wearers.size(); ++i) {
    const Wearer& wearer = *session.wearers[i];
    nlohmann::ordered_json& json = avatars[wearer.number()];
    json.erase("link");
    json["law"] = wearer.laws().to_json();
    json["contacts"] = session.result.people[i].contacts;
    json["contacts_hash"] = session.result.contacts_hashes[i];
    add_to(json, wearer.sent(), wearer.maps_reloaded());
    json["link"] = link_of(wearer);
  }
  return avatars;
}

}  // namespace

nlohmann::ordered_json to_json(const LiveSession& session, const Invocation& invocation) {
  const LiveVerbOptions& options = session.options;
  const LiveResult& result = session.result;
  const Wearer& first = *session.wearers.front();
  const Detector& detector = first.detector();
  const SenderStatistics total = total_of(session.wearers);
  std::uint64_t maps_reloaded = 0;
  for (const auto& wearer : session.wearers) maps_reloaded += wearer->maps_reloaded();
  nlohmann::ordered_json json = provenance(invocation.argv);
  json["from"] = options.sources;
  json["pose"] = options.pose;
  json["detector"] = detector.name();
  json["approximate"] = detector.is_approximate();
  if (const auto kept = detector.triangles_kept()) json["triangles_kept"] = *kept;
  json["method"] = options.choice.method;
  json["law"] = first.laws().to_json();
  json["gl"] = vestige::to_json(detector.gl_info());
  json["frames"] = result.frames;
  json["colliders"] = result.colliders;
  json["contacts"] = contacts_of(result);
  json["contacts_hash"] = texture_hash_of(result.contacts_hashes);
  json["duration_s"] = result.duration_s;
  json["frames_superseded"] = result.superseded;
  json["missed_deadlines"] = result.missed_deadlines;
  json["silences"] = result.silences;
  json["lost"] = {{"malformed", result.losses.malformed},
                  {"overflowed", result.losses.overflowed},
                  {"strangers", result.losses.strangers},
                  {"ids_clash", result.losses.ids_clash}};
  json["floor_us"] = first.sink().floor().count();
  add_to(json, total, maps_reloaded);
  json["latency"] = latency_json(session, total);
  json["real_time"] = real_time_json(session.real_time);
  json["recording"] = nullptr;
  if (session.recorder != nullptr) json["recording"] = session.recorder->to_json();
  json["complete"] = total.links_lost == 0 && result.losses.total() == 0 && !result.losses.ids_clash;
  json["link"] = link_of(first);
  json["avatars"] = avatars_of(session);
  return json;
}

std::string summary(const LiveSession& session) {
  const LiveResult& result = session.result;
  std::string text =
      fmt::format("{} in {:.2f} s, {}; {} superseded by newer ones\n", counted(result.frames, "frame"),
                  result.duration_s, counted(contacts_of(result), "contact"), counted(result.superseded, "frame"));
  if (session.options.rate_hz) text += fmt::format("{} missed\n", counted(result.missed_deadlines, "deadline"));
  if (session.latency.interval.count() != 0)
    text += fmt::format("time between frames:          {}\n", describe(session.latency.interval));
  if (session.latency.pose_delay.max_us() > 0)
    text += fmt::format("poses shown late by:          {}\n", describe(session.latency.pose_delay));
  text += fmt::format("arrival to decoded:           {}\n", describe(session.latency.decoded));
  text += fmt::format("arrival to contacts found:    {}\n", describe(session.latency.detected));
  for (std::size_t i = 0; i < session.wearers.size(); ++i) {
    const Wearer& wearer = *session.wearers[i];
    if (session.people.size() > 1)
      text += fmt::format("{}: {}\n", wearer.person().name, counted(result.people[i].contacts, "contact"));
    text += summary_of(wearer, "arrival");
  }
  if (session.recorder != nullptr) text += session.recorder->describe();
  return text + fmt::format("contacts_hash {}\n", texture_hash_of(result.contacts_hashes));
}

int report_losses(const LiveSession& session) {
  const Verbosity verbosity = session.options.common.verbosity();
  const LiveLosses& losses = session.result.losses;
  int code = kDone;
  for (std::size_t i = 0; i < session.wearers.size(); ++i)
    code = std::max(code, report_losses(*session.wearers[i], session.result.people[i], verbosity));
  if (losses.total() != 0)
    warn(fmt::format("input was lost: {} could not be read, {} came too fast for the system, and {} came from a second "
                     "sender",
                     losses.malformed, losses.overflowed, losses.strangers),
         verbosity);
  const bool is_recorded = session.recorder == nullptr || session.recorder->is_complete();
  return losses.total() == 0 && !losses.ids_clash && is_recorded ? code : kDataLost;
}

}  // namespace vestige::cli
