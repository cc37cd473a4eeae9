// Bodies that maps are made for in tests.

#pragma once

#include <glm/vec2.hpp>

#include "analysis/mapping/body.hpp"
#include "detector/actuator_map.hpp"
#include "tests/support/builtin_avatar.hpp"
#include "tests/support/small_avatar.hpp"

namespace vestige::test {

inline const Body& mannequin() {
  static const Body body(builtin_avatar());
  return body;
}

inline ActuatorMap read(const ActuatorMapFiles& files) {
  return parse_actuator_map(files.png, files.json, "made");
}

/// A rectangle of skin in the plane z = 0, from (x, y) on, shown by the same rectangle of the texture, moved by
/// `shift`.
inline void add_rectangle(Avatar& avatar, glm::vec2 low, glm::vec2 high, glm::vec2 shift = glm::vec2(0)) {
  const auto first = static_cast<std::uint32_t>(avatar.position_bind.size());
  for (const glm::vec2 corner : {low, glm::vec2(high.x, low.y), high, glm::vec2(low.x, high.y)}) {
    avatar.position_bind.emplace_back(corner, 0.0F);
    avatar.texture_coordinate.push_back(corner + shift);
    Influences rigid;
    rigid.weight[0] = 1;
    avatar.influences.push_back(rigid);
  }
  avatar.triangles.emplace_back(first, first + 1, first + 2);
  avatar.triangles.emplace_back(first, first + 2, first + 3);
}

/// Nothing yet: for `add_rectangle`.
inline Avatar flat_avatar() {
  return rigid_avatar({}, {});
}

}  // namespace vestige::test
