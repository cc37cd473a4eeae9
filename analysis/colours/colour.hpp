#pragma once

#include <cstdint>
#include <string>

namespace vestige::plot {

/// sRGB and opacity, 0..255 each.
struct Colour {
  std::uint8_t red = 0;
  std::uint8_t green = 0;
  std::uint8_t blue = 0;
  std::uint8_t alpha = 255;
};

/// "#rrggbb", as in CSS; without the opacity.
std::string css(Colour colour);

}  // namespace vestige::plot
