#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace vestige {

/// The avatar that comes with Vestige, the mannequin: one closed surface of a person 1.75 m tall, 4998 triangles, on 21
/// joints, with the animations `idle`, `walk`, `reach` and `spin`; metres, y up, facing +z. Binary glTF 2.0; the same
/// bytes in every build (traces/mannequin/README.md says how they were made).
std::vector<std::byte> builtin_avatar_glb();

/// Its actuator map: six regions of the torso, right and left at three heights (after HAVE 2010, Fig. 4). 8-bit grey
/// PNG.
std::vector<std::byte> builtin_actuator_map_png();

/// The sidecar that names the six actuators.
std::string builtin_actuator_map_json();

}  // namespace vestige
