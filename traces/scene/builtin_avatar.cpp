#include "traces/scene/builtin_avatar.hpp"

#include <span>

// The three files are embedded in the program unchanged.
#define VESTIGE_EMBED(symbol, file)                                                                        \
  asm(".pushsection .rodata\n" #symbol "_begin:\n.incbin \"" VESTIGE_MANNEQUIN_DIR "/" file "\"\n" #symbol \
      "_end:\n"                                                                                            \
      ".popsection\n");                                                                                    \
  extern "C" const std::byte symbol##_begin[];                                                             \
  extern "C" const std::byte symbol##_end[]

VESTIGE_EMBED(vestige_mannequin_glb, "mannequin.glb");
VESTIGE_EMBED(vestige_mannequin_map_png, "actuator_map.png");
VESTIGE_EMBED(vestige_mannequin_map_json, "actuator_map.json");

namespace vestige {

std::vector<std::byte> builtin_avatar_glb() {
  return {vestige_mannequin_glb_begin, vestige_mannequin_glb_end};
}

std::vector<std::byte> builtin_actuator_map_png() {
  return {vestige_mannequin_map_png_begin, vestige_mannequin_map_png_end};
}

std::string builtin_actuator_map_json() {
  const std::span bytes(vestige_mannequin_map_json_begin, vestige_mannequin_map_json_end);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace vestige
