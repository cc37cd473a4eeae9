#include "detector/firing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>

#include "traces/base/error.hpp"

namespace vestige {

namespace {

constexpr const char* kFiringRemedy =
    R"(write "fires": {"chest left": {"back left": 1, "back right": 0.5}}, or leave it out)";

/// A name, or a number from 1; returned from 0.
std::uint32_t actuator_named(const std::string& word, std::span<const std::string> names, const std::string& where) {
  const auto found = std::ranges::find(names, word);
  if (found != names.end()) {
    if (std::find(found + 1, names.end(), word) != names.end())
      throw Error(where, fmt::format("several actuators are called '{}'", word), "name it by its number, from 1");
    return static_cast<std::uint32_t>(found - names.begin());
  }
  std::uint32_t number = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (error == std::errc() && end == word.data() + word.size() && number >= 1 && number <= names.size())
    return number - 1;
  constexpr std::size_t kMostNamed = 20;
  throw Error(where, fmt::format("there is no actuator '{}'", word),
              fmt::format("the actuators are: {}{}; or name them by their numbers, 1 to {}",
                          fmt::join(names.first(std::min(names.size(), kMostNamed)), ", "),
                          names.size() > kMostNamed ? ", …" : "", names.size()));
}

}  // namespace

Firing::Firing(const nlohmann::json& fires, std::span<const std::string> names, const std::string& where) {
  if (!fires.is_object()) throw Error(where, "'fires' is not an object", kFiringRemedy);
  for (const auto& [region, list] : fires.items()) {
    const std::string place = fmt::format("{}, fires, '{}'", where, region);
    if (!list.is_object()) throw Error(place, "is not an object of actuators and gains", kFiringRemedy);
    const auto [entry, is_new] = elsewhere_.try_emplace(actuator_named(region, names, fmt::format("{}, fires", where)));
    if (!is_new) throw Error(place, "is listed twice, by its name and by its number", "list it once");
    std::vector<Fired>& fired = entry->second;
    for (const auto& [word, gain] : list.items()) {
      const std::uint32_t actuator = actuator_named(word, names, place);
      if (!gain.is_number() || !(gain.get<double>() > 0) || !(gain.get<double>() <= 1))
        throw Error(place, fmt::format("the gain of '{}' is {}, and not above 0 and at most 1", word, gain.dump()),
                    kFiringRemedy);
      if (std::ranges::find(fired, actuator, &Fired::actuator) != fired.end())
        throw Error(place, fmt::format("actuator {} is listed twice", actuator + 1), "list it once");
      fired.push_back({actuator, gain.get<double>()});
    }
    std::ranges::sort(fired, {}, &Fired::actuator);
  }
}

std::vector<std::uint32_t> Firing::first_alike(std::size_t regions) const {
  std::map<std::vector<std::uint32_t>, std::uint32_t> first;
  std::vector<std::uint32_t> alike(regions);
  for (std::uint32_t region = 0; region < regions; ++region) {
    std::vector<std::uint32_t> actuators;
    for_each(region, [&](const Fired& fired) { actuators.push_back(fired.actuator); });
    alike[region] = first.try_emplace(std::move(actuators), region).first->second;
  }
  return alike;
}

std::vector<Fired> Firing::of(std::uint32_t region) const {
  const auto found = elsewhere_.find(region);
  return found == elsewhere_.end() ? std::vector<Fired>{{region, 1}} : found->second;
}

const std::vector<double>& Firing::apply(const std::vector<double>& asked, std::vector<double>& room) const {
  if (is_own()) return asked;
  room = asked;
  for (const auto& [region, list] : elsewhere_) room[region] = 0;
  for (const auto& [region, list] : elsewhere_)
    for (const auto& [actuator, gain] : list) room[actuator] = std::max(room[actuator], gain * asked[region]);
  return room;
}

std::string describe(std::span<const Fired> fired, std::span<const std::string> names) {
  if (fired.empty()) return "nothing";
  constexpr std::size_t kMostDescribed = 6;
  std::string text;
  for (const auto& [actuator, gain] : fired.first(std::min(fired.size(), kMostDescribed)))
    text +=
        fmt::format("{}{}{}", text.empty() ? "" : ", ", names[actuator], gain == 1 ? "" : fmt::format(" ({})", gain));
  if (fired.size() > kMostDescribed) text += fmt::format(" and {} more", fired.size() - kMostDescribed);
  return text;
}

}  // namespace vestige
