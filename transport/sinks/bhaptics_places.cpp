#include "transport/sinks/bhaptics_places.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <optional>

#include "traces/base/error.hpp"
#include "traces/timeline/bhaptics_vest.hpp"

namespace vestige {

namespace {

struct Device {
  std::string_view position;
  std::size_t size = 0;
};

constexpr Device kDevices[] = {{kBhapticsSides[0], kBhapticsSideActuators},
                               {kBhapticsSides[1], kBhapticsSideActuators},
                               {"Head", 6},
                               {"ForearmL", 6},
                               {"ForearmR", 6},
                               {"HandL", 3},
                               {"HandR", 3},
                               {"FootL", 3},
                               {"FootR", 3}};
constexpr std::string_view kSidesOfLayout[] = {"front", "back"};  // in the order of kBhapticsSides

/// Reads a number from `first` up to and without `end`.
std::optional<std::size_t> number_in(std::string_view text, std::size_t first, std::size_t end) {
  std::size_t number = 0;
  const auto [rest, failure] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (failure != std::errc() || rest != text.data() + text.size() || number < first || number >= end)
    return std::nullopt;
  return number;
}

std::optional<BhapticsPlace> place_by_number(std::string_view number) {
  const auto found = number_in(number, 1, kBhapticsSideActuators * std::size(kBhapticsSides) + 1);
  if (!found) return std::nullopt;
  return BhapticsPlace{kBhapticsSides[(*found - 1) / kBhapticsSideActuators], (*found - 1) % kBhapticsSideActuators};
}

/// `cell` is ROW-COLUMN, both from 1 on.
std::optional<std::size_t> index_of_cell(std::string_view cell) {
  const std::size_t dash = cell.find('-');
  if (dash == std::string_view::npos) return std::nullopt;
  const auto row = number_in(cell.substr(0, dash), 1, kBhapticsSideRows + 1);
  const auto column = number_in(cell.substr(dash + 1), 1, kBhapticsSideColumns + 1);
  if (!row || !column) return std::nullopt;
  return (*row - 1) * kBhapticsSideColumns + *column - 1;
}

std::optional<BhapticsPlace> place_of(std::string_view name) {
  const std::size_t space = name.find(' ');
  if (space == std::string_view::npos) return place_by_number(name);
  const std::string_view before = name.substr(0, space);
  const std::string_view after = name.substr(space + 1);
  if (before == "actuator") return place_by_number(after);
  const auto* const device = std::ranges::find(kDevices, before, &Device::position);
  if (device != std::end(kDevices)) {
    if (const auto index = number_in(after, 0, device->size)) return BhapticsPlace{device->position, *index};
  }
  const auto* const side = std::ranges::find(kSidesOfLayout, before);
  if (side != std::end(kSidesOfLayout)) {
    if (const auto index = index_of_cell(after))
      return BhapticsPlace{kBhapticsSides[side - std::begin(kSidesOfLayout)], *index};
  }
  return std::nullopt;
}

}  // namespace

std::vector<BhapticsPlace> bhaptics_places(const std::vector<std::string>& actuator_names, const std::string& subject) {
  std::vector<BhapticsPlace> places;
  places.reserve(actuator_names.size());
  for (const std::string& name : actuator_names) {
    const std::optional<BhapticsPlace> place = place_of(name);
    if (!place)
      throw Error(subject, fmt::format("bHaptics' devices have no vibrator for the actuator '{}'", name),
                  "use --map torso40, or name the actuators of your map VestFront 0 to 19 and VestBack 0 to 19");
    if (const auto twin = std::ranges::find(places, *place); twin != places.end())
      throw Error(subject,
                  fmt::format("the actuators '{}' and '{}' would be the same vibrator",
                              actuator_names[static_cast<std::size_t>(twin - places.begin())], name),
                  "give them names of different vibrators");
    places.push_back(*place);
  }
  return places;
}

}  // namespace vestige
