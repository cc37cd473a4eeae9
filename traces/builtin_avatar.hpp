#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace vestige {

/// The avatar that comes with Vestige: a closed, smooth body 1.75 m tall on a chain of 20 joints, 5000 triangles, with
/// the animation `sway`. Binary glTF 2.0; the same bytes at every call.
std::vector<std::byte> builtin_avatar_glb();

/// Its actuator map: six regions of the torso, left and right at three heights (after HAVE 2010, Fig. 4). 8-bit grey
/// PNG.
std::vector<std::byte> builtin_actuator_map_png();

/// The sidecar that names the six actuators.
std::string builtin_actuator_map_json();

}  // namespace vestige
