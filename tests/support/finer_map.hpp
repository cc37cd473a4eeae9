#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "detector/actuators/actuator_layout.hpp"
#include "tests/support/builtin_avatar.hpp"
#include "tests/support/builtin_map.hpp"

namespace vestige::test {

/// Returns the built-in map with `columns` x `rows` actuators around the torso. Each mapped texel has one of them.
inline ActuatorMap finer_map(std::uint16_t columns, std::uint16_t rows) {
  ActuatorMap map = builtin_map();
  const Avatar& avatar = builtin_avatar();
  const ActuatorLayout six(avatar, map);
  std::vector<std::uint16_t> actuator(map.actuator.size(), 0);
  for (std::uint32_t number = 0; number < avatar.triangles.size(); ++number) {
    const glm::uvec3& corner = avatar.triangles[number];
    for (int i = 0; i <= 60; ++i) {
      for (int j = 0; i + j <= 60; ++j) {
        const glm::dvec3 weight(1 - (i + j) / 60.0, i / 60.0, j / 60.0);
        const glm::dvec2 at = weight.x * glm::dvec2(avatar.texture_coordinate[corner.x]) +
                              weight.y * glm::dvec2(avatar.texture_coordinate[corner.y]) +
                              weight.z * glm::dvec2(avatar.texture_coordinate[corner.z]);
        if (map.at(at) == 0) continue;
        const glm::dvec3 place = six.surface().position_of({number, weight});
        const double around = std::atan2(place.x, place.z) / 6.2831853 + 0.5;
        const double up = std::clamp((place.y - 0.9) / 0.55, 0.0, 0.999);
        const auto column = static_cast<std::uint16_t>(std::min(around * columns, columns - 1.0));
        const auto row = static_cast<std::uint16_t>(up * rows);
        actuator[std::size_t{std::min(static_cast<std::uint32_t>(at.y * map.height), map.height - 1)} * map.width +
                 std::min(static_cast<std::uint32_t>(at.x * map.width), map.width - 1)] =
            static_cast<std::uint16_t>(1 + row * columns + column);
      }
    }
  }
  map.actuator = std::move(actuator);
  map.actuator_count = std::size_t{columns} * rows;
  map.names.assign(map.actuator_count, "");
  map.position_m.assign(map.actuator_count, std::nullopt);
  return map;
}

}  // namespace vestige::test
