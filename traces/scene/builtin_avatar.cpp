#include "traces/scene/builtin_avatar.hpp"

#include <span>

#include "traces/base/embed.hpp"

VESTIGE_EMBED(vestige_mannequin_glb, VESTIGE_MANNEQUIN_DIR "/mannequin.glb");
VESTIGE_EMBED(vestige_mannequin_map_png, VESTIGE_MANNEQUIN_DIR "/actuator_map.png");
VESTIGE_EMBED(vestige_mannequin_map_json, VESTIGE_MANNEQUIN_DIR "/actuator_map.json");

namespace vestige {

std::vector<std::byte> builtin_avatar_glb() {
  return VESTIGE_EMBEDDED(vestige_mannequin_glb);
}

std::vector<std::byte> builtin_actuator_map_png() {
  return VESTIGE_EMBEDDED(vestige_mannequin_map_png);
}

std::string builtin_actuator_map_json() {
  const std::span bytes(vestige_mannequin_map_json_begin, vestige_mannequin_map_json_end);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace vestige
