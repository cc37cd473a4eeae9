#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/mapping/body.hpp"
#include "analysis/mapping/map_raster.hpp"
#include "analysis/mapping/region_plan.hpp"
#include "detector/actuator_map.hpp"

namespace vestige {

/// What to do about an actuator that has no skin.
enum class EmptyRegions { kRefuse, kLeaveOut };

struct MapSettings {
  std::uint32_t side = 1024;  ///< texels, 16 … 16384
  std::uint32_t padding = 4;  ///< texels
  EmptyRegions empty = EmptyRegions::kRefuse;
  /// One texel for each triangle, instead of the avatar's UV space. `side` and `padding` are then ignored.
  bool per_triangle = false;
  std::string fires;      ///< JSON for the sidecar (`Firing`); empty: every region fires its own actuator
  WorkProgress progress;  ///< may be empty
};

struct MadeActuator {
  std::string name;
  std::uint16_t grey = 0;
  /// The position asked for. Otherwise the point of the region's skin that is nearest to the region's centroid by area.
  glm::dvec3 position_m = glm::dvec3(0);
  double area_m2 = 0;  ///< area of the actuator's skin
};

struct MadeMap {
  ActuatorMapFiles files;
  std::vector<MadeActuator> actuators;
  std::vector<std::string> left_out;  ///< names of actuators that have no skin
  MapRaster raster;                   ///< holds the actuators' numbers
  std::size_t triangle_count = 0;     ///< as in `ActuatorMap`
  /// The share of skin that does not fire its own actuator, of all skin that should fire or does: what the texture
  /// cannot tell apart.
  double misplaced_share = 0;
  std::vector<std::string> warnings;  ///< one sentence each, for example about texels with two claims
};

/// Draws regions into the avatar's texture and returns them as the two files of a map. In a map per triangle, each
/// triangle belongs to the actuator that has most of it, but each actuator with skin gets at least one triangle. Throws
/// `Error` if the avatar has no texture coordinates (named `avatar_name`), or if an actuator has no skin (named
/// `name`).
MadeMap make_map(const Body& body, const RegionPlan& plan, const MapSettings& settings, std::string_view name,
                 std::string_view avatar_name);

}  // namespace vestige
