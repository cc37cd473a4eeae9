#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "detector/actuators/actuator_layout.hpp"
#include "detector/contact.hpp"
#include "tests/support/small_avatar.hpp"

namespace vestige::test {

/// Returns a flat square of skin, 1 m wide, in z = 0 from (0, 0) to (1, 1). It consists of `cells` x `cells` squares of
/// two triangles each. Its texture coordinates are x and y.
inline Avatar flat_body(int cells) {
  std::vector<glm::vec3> vertices;
  std::vector<glm::uvec3> triangles;
  const float side = 1.0F / static_cast<float>(cells);
  for (int y = 0; y <= cells; ++y)
    for (int x = 0; x <= cells; ++x)
      vertices.emplace_back(side * static_cast<float>(x), side * static_cast<float>(y), 0.0F);
  for (int y = 0; y < cells; ++y) {
    for (int x = 0; x < cells; ++x) {
      const auto corner = static_cast<unsigned>(y * (cells + 1) + x);
      const auto above = corner + static_cast<unsigned>(cells) + 1;
      triangles.emplace_back(corner, corner + 1, above + 1);
      triangles.emplace_back(corner, above + 1, above);
    }
  }
  return rigid_avatar(vertices, triangles);
}

/// Returns a contact at (x, y) of `flat_body(cells)`, both within [0, 1].
inline Contact contact_at(double x, double y, int cells) {
  const double across = std::min(std::floor(x * cells), cells - 1.0);
  const double up = std::min(std::floor(y * cells), cells - 1.0);
  const double dx = x * cells - across;
  const double dy = y * cells - up;
  Contact contact;
  const auto cell = static_cast<std::uint32_t>(up * cells + across);
  contact.triangle = 2 * cell + (dx >= dy ? 0 : 1);
  contact.barycentric = dx >= dy ? glm::dvec2(dx - dy, dy) : glm::dvec2(dx, dy - dx);
  contact.texture_coordinate = {x, y};
  contact.t = 1;
  return contact;
}

/// Returns a map of that square with `size` x `size` texels and an actuator at each of `places`. Each texel has the
/// nearest actuator, or is black if no actuator is within `reach_m`.
inline ActuatorMap nearest_map(const std::vector<glm::dvec2>& places, std::uint32_t size, double reach_m = 10) {
  ActuatorMap map;
  map.width = map.height = size;
  map.actuator.assign(std::size_t{size} * size, 0);
  map.actuator_count = places.size();
  for (const glm::dvec2& place : places) {
    map.names.push_back("actuator " + std::to_string(map.names.size() + 1));
    map.position_m.emplace_back(glm::dvec3(place, 0));
  }
  for (std::uint32_t row = 0; row < size; ++row) {
    for (std::uint32_t column = 0; column < size; ++column) {
      const glm::dvec2 at = (glm::dvec2(column, row) + 0.5) / static_cast<double>(size);
      const auto away = [&](const glm::dvec2& place) { return std::hypot(place.x - at.x, place.y - at.y); };
      const auto nearest = std::ranges::min_element(places, {}, away);
      if (away(*nearest) <= reach_m)
        map.actuator[std::size_t{row} * size + column] = static_cast<std::uint16_t>(nearest - places.begin() + 1);
    }
  }
  return map;
}

}  // namespace vestige::test
