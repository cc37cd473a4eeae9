#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "analysis/mapping/body_surface.hpp"
#include "detector/actuator_map.hpp"

namespace vestige {

/// A bit of skin of about a texel (about 7 mm of a grown person where the map is per triangle), as a contact there
/// would see it.
struct SkinPatch {
  glm::vec3 position_m = glm::vec3(0);
  float area_m2 = 0;
  std::uint32_t texel = 0;     ///< where the map is looked up
  std::uint16_t actuator = 0;  ///< what it says
  std::uint32_t piece = 0;     ///< one of the actuator's pieces: connected on the body, also across seams
};

/// The whole skin under a map, in patches about a texel large (coarser where there would be more than 2^23 of them).
/// Patches are neighbours where triangles share an edge on the body, whatever the texture does there.
std::vector<SkinPatch> skin_pieces(const BodySurface& surface, const ActuatorMap& map);

}  // namespace vestige
