#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "analysis/mapping/body_surface.hpp"

namespace vestige {

/// Two points of the skin are far apart, so that one texel for both is a mistake, from this share of the body's height
/// on: 3.5 cm of a grown person.
inline constexpr double kFarApart = 0.02;

/// A square actuator map in the making.
struct MapRaster {
  std::uint32_t side = 0;
  std::vector<std::uint16_t> actuator;  ///< side x side, row 0 at the top
  std::size_t texels_of_skin = 0;       ///< that triangles touch
  /// Texels whose middle lies on two stretches of skin far apart that belong to different actuators (0: none), by the
  /// pair; the texel has the first.
  std::map<std::pair<std::uint16_t, std::uint16_t>, std::size_t> conflicts;
  /// That cover nothing: their texture coordinates are not finite, or cover the texture more than once over.
  std::size_t triangles_left_out = 0;
};

using ActuatorAt = std::function<std::uint16_t(const SkinPoint&)>;

/// Gives each texel the actuator of the skin that it shows: of the point at its middle, or, where the skin ends within
/// it, of the point that is nearest to its middle. Texels that show none, up to `padding` texels from skin, take over
/// from the nearest that does, so that no rounding at a seam falls into the void; those that belong to a chart, black
/// ones too, keep what they have. Where charts lie upon each other, an actuator goes before none, and the earlier
/// triangle before the later.
MapRaster rasterise(const BodySurface& surface, const ActuatorAt& actuator_at, std::uint32_t side,
                    std::uint32_t padding);

}  // namespace vestige
