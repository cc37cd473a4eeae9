#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "detector/actuator_map.hpp"
#include "detector/detector.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige {

/// The triangles that may fire an actuator, ascending. One that is left out is proven to fire none: all texels that its
/// texture coordinates cover, and a texel around them, are without an actuator. Kept without a look: triangles whose
/// texture coordinates are not finite, lie beyond 2^20 texels, or cover the map more than once over. Of a map by
/// triangle, those with an actuator.
std::vector<std::uint32_t> mapped_triangles(const Avatar& avatar, const ActuatorMap& map);

/// Makes a detector for an avatar and its map, to which the detector keeps references.
using DetectorMaker = std::function<std::unique_ptr<Detector>(const Avatar&, const ActuatorMap&)>;

/// For `Surface::kMapped`, where a triangle that fires nothing hides nothing either: the detector of `make` on the
/// triangles that are mapped alone, with the triangle numbers of the whole avatar. The same result with less work.
/// Holds references to `avatar` and `map`, and a copy without the triangles left out.
std::unique_ptr<Detector> on_mapped_skin(const Avatar& avatar, const ActuatorMap& map, const DetectorMaker& make);

}  // namespace vestige
