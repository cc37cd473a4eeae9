#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <string>
#include <vector>

#include "traces/mannequin/surface.hpp"

namespace vestige::mannequin {

/// The panels into which the skin is cut, as a tailor would.
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

/// A connected piece of the surface, flattened.
struct Chart {
  Panel panel;
  bool right;                            ///< the right one of a pair
  std::vector<std::uint32_t> triangles;  ///< of the surface
  std::vector<std::uint32_t> vertices;   ///< vertices of the surface, each once
  std::vector<glm::vec2> uv;             ///< one for each of `vertices`
};

/// Cuts the surface into 18 charts and flattens them as rigidly as possible (ARAP, Liu et al. 2008). All charts have
/// the same scale, stand upright, are seen from outside, and mirrored halves are mirrored. They are packed into the
/// unit square without overlap. Origin at the top left.
std::vector<Chart> make_charts(const Surface& surface);

}  // namespace vestige::mannequin
