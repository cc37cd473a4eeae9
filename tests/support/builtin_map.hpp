#pragma once

#include "detector/actuator_map.hpp"
#include "traces/scene/builtin_avatar.hpp"

namespace vestige::test {

/// The actuator map of the built-in avatar.
inline const ActuatorMap& builtin_map() {
  static const ActuatorMap map = parse_actuator_map(builtin_actuator_map_png(), builtin_actuator_map_json(), "builtin");
  return map;
}

}  // namespace vestige::test
