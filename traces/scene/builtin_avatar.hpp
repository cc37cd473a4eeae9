#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace vestige {

/// What a flag names in place of a file: the built-in avatar, or its map.
inline constexpr std::string_view kBuiltin = "builtin";

/// Returns Vestige's built-in avatar, the mannequin, as binary glTF 2.0. It is one closed surface of a person 1.75 m
/// tall with 4998 triangles and 21 joints. It has the animations `idle`, `walk`, `reach` and `spin`; metres, y up,
/// facing +z. The bytes are the same in every build (traces/mannequin/README.md describes how they are made).
std::vector<std::byte> builtin_avatar_glb();

/// Returns the mannequin's actuator map: six regions of the torso, right and left at three heights (after HAVE 2010,
/// Fig. 4). 8-bit grey PNG.
std::vector<std::byte> builtin_actuator_map_png();

/// Returns the sidecar JSON that names the map's six actuators.
std::string builtin_actuator_map_json();

}  // namespace vestige
