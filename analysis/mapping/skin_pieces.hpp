#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "analysis/mapping/body_surface.hpp"
#include "detector/actuator_map.hpp"

namespace vestige {

/// A patch of skin about one texel large, as a contact there would see it. In a map per triangle, a patch is about 7 mm
/// long on an adult.
struct SkinPatch {
  glm::vec3 position_m = glm::vec3(0);
  float area_m2 = 0;
  std::uint32_t texel = 0;     ///< the texel (or triangle) at which the map is looked up
  std::uint16_t actuator = 0;  ///< the map's actuator there
  /// A connected piece of the actuator's skin. Pieces connect on the body, also across texture seams.
  std::uint32_t piece = 0;
};

/// Returns the whole skin under a map in patches about a texel large. The patches are coarser if there would be more
/// than 2^23. Patches are neighbours if their triangles share an edge on the body, whatever the texture does there.
std::vector<SkinPatch> skin_pieces(const BodySurface& surface, const ActuatorMap& map);

}  // namespace vestige
