#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <string>
#include <vector>

#include "traces/mannequin/surface.hpp"

namespace vestige::mannequin {

/// The panels that the skin is cut into, as a tailor would.
enum class Panel : std::uint8_t {
  kTorsoFront,
  kTorsoBack,
  kHeadFront,
  kHeadBack,
  kArmOuter,
  kArmInner,
  kHandBack,
  kPalm,
  kLegFront,
  kLegBack,
  kSole
};

/// A connected piece of the surface, laid flat.
struct Chart {
  Panel panel;
  bool right;                            ///< of the pieces that come in pairs
  std::vector<std::uint32_t> triangles;  ///< of the surface
  std::vector<std::uint32_t> vertices;   ///< of the surface, each once
  std::vector<glm::vec2> uv;             ///< of each of `vertices`
};

/// Cuts the surface into 18 charts and flattens them as rigidly as possible (ARAP, Liu et al. 2008), all to one scale,
/// upright and seen from outside, mirrored halves mirrored, packed into the unit square without overlap. Origin at the
/// top left.
std::vector<Chart> make_charts(const Surface& surface);

}  // namespace vestige::mannequin
