#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "detector/actuator_map.hpp"
#include "detector/detector.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige {

/// Returns the triangles that may fire an actuator, ascending. A triangle that is left out is proven to fire none: all
/// texels that its texture coordinates cover, and one texel around them, have no actuator. Triangles whose texture
/// coordinates are not finite, lie beyond 2^20 texels, or cover the map more than once are kept without a test. For a
/// map by triangle, the result is the triangles with an actuator.
std::vector<std::uint32_t> mapped_triangles(const Avatar& avatar, const ActuatorMap& map);

/// Makes a detector for an avatar and its map. The detector keeps references to both.
using DetectorMaker = std::function<std::unique_ptr<Detector>(const Avatar&, const ActuatorMap&)>;

/// For `Surface::kMapped`, where a triangle that fires nothing also hides nothing. Returns the detector of `make` on
/// the mapped triangles alone, but with the triangle numbers of the whole avatar. The result is the same, with less
/// work. Keeps references to `avatar` and `map`, and a copy of the avatar with only the mapped triangles.
std::unique_ptr<Detector> on_mapped_skin(const Avatar& avatar, const ActuatorMap& map, const DetectorMaker& make);

}  // namespace vestige
