#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace vestige {

/// The actuator ID map (HAVE 2010 §III.B): an image in the avatar's UV space whose grey levels are actuators and whose
/// black fires nothing. Held as actuator numbers 1 … actuator_count; 0 is none.
struct ActuatorMap {
  std::uint32_t width = 1;
  std::uint32_t height = 1;
  std::vector<std::uint16_t> actuator = {0};  ///< width * height, row 0 at the top
  std::size_t actuator_count = 0;
  std::vector<std::string> names;  ///< one for each actuator
  /// One for each actuator: its middle on the skin, bind pose, metres; where the sidecar gives it.
  std::vector<std::optional<glm::dvec3>> position_m;
  std::vector<std::string> warnings;  ///< one sentence each

  /// The actuator under a texture coordinate: nearest texel floor(frac(u) W), floor(frac(v) H), origin top-left,
  /// wrapped (detector/CONTRACT.md, 8). A coordinate that is not finite has none.
  std::uint16_t at(const glm::dvec2& texture_coordinate) const;
};

/// Reads a PNG of 8 or 16 bit grey. Without a sidecar, actuators 1 … n are the distinct non-zero greys in ascending
/// order. `sidecar_json` (may be empty) says which grey is which: {"actuators": [{"grey": 40, "name": "chest left",
/// "position_m": [0.08, 1.3, 0.12]}, …]}, in the order of their numbers; a grey in the image that it does not list is
/// an error. Name and position (three finite numbers) may be left out. `name` stands in errors:
/// no PNG, truncated, colour or palette image, alpha channel, more than 65534 actuators, unusable sidecar.
ActuatorMap parse_actuator_map(std::span<const std::byte> png, std::string_view sidecar_json, std::string_view name);

/// A map's two files.
struct ActuatorMapFiles {
  std::vector<std::byte> png;
  std::string json;  ///< may be empty
};

/// `map`: "none" (both are empty), "builtin", or a PNG file, whose sidecar is the .json of the same name, if there is
/// one. Throws `Error` where a file cannot be read.
ActuatorMapFiles read_actuator_map_files(const std::string& map);

}  // namespace vestige
