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
/// coordinates are not finite, lie beyond 2^20 texels, or cover the map more than once are kept without a test. Of
/// a map by triangle, returns the triangles that have an actuator.
std::vector<std::uint32_t> mapped_triangles(const Avatar& avatar, const ActuatorMap& map);

/// Makes a detector for an avatar and its map. The detector keeps references to both.
using DetectorMaker = std::function<std::unique_ptr<Detector>(const Avatar&, const ActuatorMap&)>;

/// Returns the detector of `make` on the mapped triangles alone, but with the triangle numbers of the whole avatar. The
/// contacts are those that `Surface::kMapped` asks for, with less work: a triangle that fires nothing hides nothing.
/// Keeps references to `avatar` and `map`, and a copy of the avatar with only the mapped triangles.
std::unique_ptr<Detector> on_mapped_skin(const Avatar& avatar, const ActuatorMap& map, const DetectorMaker& make);

}  // namespace vestige
