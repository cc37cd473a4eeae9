#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/colours/colour.hpp"

namespace vestige::plot {

// Okabe and Ito, "Color Universal Design" (2008): distinguishable with every common colour blindness.
inline constexpr Colour kBlack = {0, 0, 0};
inline constexpr Colour kOrange = {230, 159, 0};
inline constexpr Colour kSkyBlue = {86, 180, 233};
inline constexpr Colour kGreen = {0, 158, 115};
inline constexpr Colour kBlue = {0, 114, 178};
inline constexpr Colour kVermillion = {213, 94, 0};
inline constexpr Colour kPurple = {204, 121, 167};

// Tol, "Colour Schemes" (SRON, 2021), muted: darker than the others.
inline constexpr Colour kOlive = {153, 153, 51};
inline constexpr Colour kWine = {136, 34, 85};
inline constexpr Colour kIndigo = {51, 34, 136};

// Neither has a further colour that is far from all of these.
inline constexpr Colour kBrown = {110, 62, 24};

/// Colours for lines on white. They exclude yellow, which is too pale, and black, which marks the published points.
inline constexpr std::array<Colour, 10> kLineColours = {kBlue,    kVermillion, kGreen, kPurple, kOrange,
                                                        kSkyBlue, kOlive,      kWine,  kIndigo, kBrown};

/// Returns a line colour for each detector. A detector has the same colour in every figure. If a detector occurs twice,
/// the second line takes a colour that is free, and so does a detector without a colour of its own.
inline std::vector<Colour> line_colours(const std::vector<std::string>& detectors) {
  constexpr std::array<std::string_view, kLineColours.size()> kOwners = {
      "paper", "geometry", "cpu", "embree", "embree_default", "exact", "boxes", "capsules", "decimated", "compute"};
  std::array<bool, kLineColours.size()> taken = {};
  std::vector<std::size_t> numbers(detectors.size(), kLineColours.size());
  for (std::size_t i = 0; i < detectors.size(); ++i) {
    const auto owner = std::ranges::find(kOwners, detectors[i]);
    const auto number = static_cast<std::size_t>(owner - kOwners.begin());
    if (owner == kOwners.end() || taken[number]) continue;
    taken[number] = true;
    numbers[i] = number;
  }
  std::vector<Colour> colours;
  colours.reserve(numbers.size());
  std::size_t next = 0;
  for (std::size_t number : numbers) {
    if (number == kLineColours.size()) {
      const auto free = std::ranges::find(taken, false);
      number = free == taken.end() ? next++ % kLineColours.size() : static_cast<std::size_t>(free - taken.begin());
      taken[number] = true;
    }
    colours.push_back(kLineColours[number]);
  }
  return colours;
}

/// Colours for actuators on white. Grey is for unmapped skin.
inline constexpr std::array<Colour, 7> kActuatorColours = {kBlue,    kOrange, kGreen, kVermillion,
                                                           kSkyBlue, kPurple, kBlack};
inline constexpr Colour kUnmapped = {150, 150, 150};
/// A motor that runs, on skin: also in `analysis/view/page`.
inline constexpr Colour kRunning = {255, 212, 0};

inline constexpr Colour kInk = {40, 40, 40};
inline constexpr Colour kSmallPrint = {105, 105, 105};
inline constexpr Colour kGrid = {225, 225, 225};
inline constexpr Colour kWhite = {255, 255, 255};

/// Returns the sRGB channel value for an amount of light, 0..1 (IEC 61966-2-1).
inline std::uint8_t srgb_channel(double light) {
  const double value = std::clamp(light, 0.0, 1.0);
  const double shown = value <= 0.0031308 ? value * 12.92 : 1.055 * std::pow(value, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(shown * 255));
}

/// Returns `from` for `part` 0 and `to` for `part` 1.
inline Colour blend(Colour from, Colour to, double part) {
  const auto channel = [part](std::uint8_t low, std::uint8_t high) {
    return static_cast<std::uint8_t>(std::lround(std::lerp(low, high, part)));
  };
  return {channel(from.red, to.red), channel(from.green, to.green), channel(from.blue, to.blue)};
}

/// Returns the colour of an amount, 0..1. It goes evenly from almost white to dark, and so also works in grey print.
inline Colour amount_ramp(double part) {
  constexpr Colour kPale = {238, 241, 245};
  constexpr Colour kDark = {8, 29, 66};
  return part < 0.6 ? blend(kPale, kBlue, part / 0.6) : blend(kBlue, kDark, (part - 0.6) / 0.4);
}

/// Returns the colour of a number among many, 0..1. Each colour is visible on white, neighbours are similar, and
/// colours become darker throughout.
inline Colour number_ramp(double part) {
  constexpr Colour kMiddle = {122, 30, 98};
  constexpr Colour kDark = {10, 14, 60};
  if (part < 0.35) return blend(kOrange, kVermillion, part / 0.35);
  return part < 0.7 ? blend(kVermillion, kMiddle, (part - 0.35) / 0.35) : blend(kMiddle, kDark, (part - 0.7) / 0.3);
}

}  // namespace vestige::plot
