#include "analysis/colours/region_colours.hpp"

#include <array>
#include <cmath>

#include "analysis/colours/palette.hpp"

namespace vestige::plot {

namespace {

/// Ottosson's Oklab (2020): equal lightness looks equally light whatever the hue.
Colour oklch(double lightness, double chroma, double hue) {
  const double a = chroma * std::cos(hue);
  const double b = chroma * std::sin(hue);
  const double l = std::pow(lightness + 0.3963377774 * a + 0.2158037573 * b, 3);
  const double m = std::pow(lightness - 0.1055613458 * a - 0.0638541728 * b, 3);
  const double s = std::pow(lightness - 0.0894841775 * a - 1.2914855480 * b, 3);
  return {srgb_channel(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
          srgb_channel(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
          srgb_channel(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s)};
}

}  // namespace

Colour region_colour(std::size_t number, std::size_t count) {
  if (number == 0) return {206, 203, 199};
  if (count <= kActuatorColours.size()) return kActuatorColours[number - 1];
  constexpr std::array<double, 3> kLightness = {0.52, 0.80, 0.66};
  constexpr double kGoldenTurn = 2.399963229728653;  // neighbouring numbers far apart, and all spread evenly
  const double lightness = kLightness[(number - 1) % kLightness.size()];
  return oklch(lightness, 0.125, kGoldenTurn * static_cast<double>(number - 1));
}

Colour ink_on(Colour ground) {
  const double brightness = 0.299 * ground.red + 0.587 * ground.green + 0.114 * ground.blue;
  return brightness > 140 ? kBlack : kWhite;
}

}  // namespace vestige::plot
