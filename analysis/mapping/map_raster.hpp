#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "analysis/mapping/body_surface.hpp"

namespace vestige {

/// Two points of the skin are far apart if their distance is at least this share of the body's longest side. One texel
/// for both points is then a mistake. On an adult it is 3.5 cm.
inline constexpr double kFarApart = 0.02;

/// A square actuator map while it is made.
struct MapRaster {
  std::uint32_t side = 0;
  std::vector<std::uint16_t> actuator;  ///< side x side, row 0 at the top
  std::size_t texels_of_skin = 0;       ///< texels that triangles touch
  /// The number of conflicting texels for each pair of actuators (0: no actuator). The middle of such a texel lies on
  /// two stretches of skin that are far apart and belong to different actuators. The texel has the first of the pair.
  std::map<std::pair<std::uint16_t, std::uint16_t>, std::size_t> conflicts;
  /// Triangles that cover nothing: their texture coordinates are not finite, or cover the texture more than once over.
  std::size_t triangles_left_out = 0;
};

using ActuatorAt = std::function<std::uint16_t(const SkinPoint&)>;

/// Gives each texel the actuator of the skin that it shows. This is the skin at the texel's middle. If the skin ends
/// within the texel, it is the skin nearest to the middle. A texel that shows no skin, but lies at most `padding`
/// texels from skin, takes the actuator of the nearest texel that shows skin. So a look-up that is rounded at a seam
/// still finds an actuator. Texels that belong to a chart keep their actuator, black ones too. Where charts overlap, an
/// actuator takes precedence over none, and the earlier triangle over the later.
MapRaster rasterise(const BodySurface& surface, const ActuatorAt& actuator_at, std::uint32_t side,
                    std::uint32_t padding, const WorkProgress& progress);

}  // namespace vestige
