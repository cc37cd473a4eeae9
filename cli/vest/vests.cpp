#include "cli/vest/vests.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "analysis/mapping/layouts.hpp"
#include "detector/actuators/actuator_map_watch.hpp"
#include "traces/base/error.hpp"

namespace vestige::cli {

bool is_watched(const std::string& map) {
  return map != "builtin" && !is_layout(map);
}

std::vector<std::string> stamps_of(const std::vector<PersonValue>& maps) {
  std::vector<std::string> stamps;
  stamps.reserve(maps.size());
  for (const PersonValue& map : maps) stamps.push_back(is_watched(map.value) ? ActuatorMapWatch::stamp(map.value) : "");
  return stamps;
}

void check_vest_flags(const VestOptions& options, const std::vector<PersonValue>& maps) {
  options.law.check();
  if (options.sink.quantity() == Quantity::kPressure && options.law.any())
    throw UsageError(options.law.actuator.empty() ? "--law" : "--actuator",
                     "pressures have their own law, which uses the speed of contacts", "leave it out");
  if (!maps.empty() && options.choice.surface == "mapped")
    throw UsageError("--map", "may change during the playback, which --surface mapped cannot follow",
                     "leave one of the two out");
  for (const PersonValue& map : maps) {
    if (map.value == "none")
      throw UsageError("--map", "'none' has no actuator to switch",
                       "name a map, or leave the flag out to use the trace's map");
    if (is_watched(map.value) && options.choice.detector == "paper")
      throw UsageError("--map", "may change during the playback, which --detector paper cannot follow",
                       "choose another detector");
  }
}

std::vector<PersonValue> parse_ports(const VestOptions& options) {
  std::vector<PersonValue> ports = parse_person_values(kPortFlag, options.ports);
  std::set<std::string> taken;
  for (const PersonValue& port : ports)
    if (!taken.insert(port.value).second)
      throw UsageError(
          "--port",
          fmt::format("'{}' would be the {} of two people", port.value, options.plays_people() ? "port" : "vest"),
          "give each person a port of their own");
  return ports;
}

std::vector<WornVest> vests_of(const VestOptions& options, const std::vector<PersonValue>& ports,
                               const std::vector<PersonValue>& maps, const std::vector<std::string>& stamps,
                               std::size_t people) {
  std::vector<WornVest> vests;
  vests.reserve(ports.size());
  for (const PersonValue& port : ports) {
    WornVest& vest = vests.emplace_back();
    vest.person = person_of(port, kPortFlag, people, options.scene);
    vest.port = port.value;
  }
  std::ranges::sort(vests, {}, &WornVest::person);
  for (std::size_t i = 0; i < maps.size(); ++i) {
    const auto vest = std::ranges::find(vests, maps[i].person.value_or(0), &WornVest::person);
    if (vest == vests.end())
      throw UsageError("--map",
                       fmt::format("person {} has no --port, so nobody feels the map '{}'",
                                   maps[i].person.value_or(0) + 1, maps[i].value),
                       "leave it out, or give that person a port");
    vest->map = maps[i].value;
    vest->map_stamp = stamps[i];
  }
  if (options.log.empty()) return vests;
  if (vests.size() > 1 && is_pipe(options.log))
    throw UsageError("--log", fmt::format("each of {} vests has a log, and '{}' takes one", vests.size(), options.log),
                     "name a file: OUT.csv is the first vest's; that of any other person K is OUT.K.csv");
  for (WornVest& vest : vests)
    vest.log = &vest == &vests.front() ? options.log : numbered_path(options.log, vest.person);
  return vests;
}

Wearers make_wearers(const VestOptions& options, const std::vector<WornVest>& vests, std::vector<TracedPerson>& people,
                     const std::string& detector, SharedContext& context) {
  Wearers wearers;
  wearers.reserve(vests.size());
  for (const WornVest& vest : vests)
    wearers.push_back(std::make_unique<Wearer>(options, vest, people[vest.person], detector, context));
  return wearers;
}

std::vector<DetectedPerson> detected_people(const Wearers& wearers) {
  std::vector<DetectedPerson> people;
  people.reserve(wearers.size());
  for (const auto& wearer : wearers) people.push_back({wearer->number(), wearer->person().avatar, wearer->detector()});
  return people;
}

std::vector<LawMaker::Law> make_laws(const Wearers& wearers) {
  std::vector<LawMaker::Law> laws;
  laws.reserve(wearers.size());
  for (const auto& wearer : wearers) laws.push_back(wearer->make_law());
  return laws;
}

void finish(const Wearers& wearers) {
  for (const auto& wearer : wearers) wearer->stop();
  for (const auto& wearer : wearers) wearer->finish();
}

void commit(const Wearers& wearers) {
  for (const auto& wearer : wearers) wearer->commit();
}

}  // namespace vestige::cli
