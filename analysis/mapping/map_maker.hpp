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

/// What to do about an actuator that no skin belongs to.
enum class EmptyRegions { kRefuse, kLeaveOut };

struct MapSettings {
  std::uint32_t side = 1024;  ///< texels, 16 … 16384
  std::uint32_t padding = 4;  ///< texels
  EmptyRegions empty = EmptyRegions::kRefuse;
  /// One texel for each triangle instead of the avatar's UV space; `side` and `padding` mean nothing then.
  bool per_triangle = false;
};

struct MadeActuator {
  std::string name;
  std::uint16_t grey = 0;
  glm::dvec3 position_m = glm::dvec3(0);  ///< as asked for, else the region's point nearest to its middle, by area
  double area_m2 = 0;                     ///< of its skin
};

struct MadeMap {
  ActuatorMapFiles files;
  std::vector<MadeActuator> actuators;
  std::vector<std::string> left_out;  ///< names of actuators that no skin belongs to
  MapRaster raster;                   ///< by the actuators' numbers
  std::size_t triangle_count = 0;     ///< as in `ActuatorMap`
  double misplaced_share = 0;         ///< of the skin that should fire or does: what the texture cannot tell apart
  std::vector<std::string> warnings;  ///< one sentence each: texels with two claims, and such
};

/// Draws regions into the avatar's texture and writes them as a map's two files. Per triangle, each belongs to the
/// region that has most of it. `name` stands in errors: an avatar without texture coordinates (`avatar_name`), an
/// actuator that no skin belongs to.
MadeMap make_map(const Body& body, const RegionPlan& plan, const MapSettings& settings, std::string_view name,
                 std::string_view avatar_name);

}  // namespace vestige
