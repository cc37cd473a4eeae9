#include "analysis/colours/colour.hpp"

#include <fmt/format.h>

namespace vestige::plot {

std::string css(Colour colour) {
  return fmt::format("#{:02x}{:02x}{:02x}", colour.red, colour.green, colour.blue);
}

}  // namespace vestige::plot
