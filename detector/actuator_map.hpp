#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "traces/scene/avatar.hpp"

namespace vestige {

class TraceReader;

/// The actuator ID map (HAVE 2010 §III.B): an image whose grey levels are actuators and whose black fires nothing. Held
/// as actuator numbers 1 … actuator_count; 0 is none.
struct ActuatorMap {
  /// 0: the image lies in the avatar's UV space. Otherwise texel k, row by row, is the avatar's triangle k, and there
  /// are this many: for avatars whose texture coordinates cannot tell places of the skin apart.
  std::size_t triangle_count = 0;
  std::uint32_t width = 1;
  std::uint32_t height = 1;
  std::vector<std::uint16_t> actuator = {0};  ///< width * height, row 0 at the top
  std::size_t actuator_count = 0;
  std::vector<std::string> names;  ///< one for each actuator
  /// One for each actuator: its middle on the skin, bind pose, metres; where the sidecar gives it.
  std::vector<std::optional<glm::dvec3>> position_m;
  std::string skin_digest;            ///< of the avatar whose triangles these are; may be empty
  std::vector<std::string> warnings;  ///< one sentence each

  /// The actuator under a texture coordinate: nearest texel floor(frac(u) W), floor(frac(v) H), origin top-left,
  /// wrapped (detector/CONTRACT.md, 8). A coordinate that is not finite has none.
  std::uint16_t at(const glm::dvec2& texture_coordinate) const;
  /// The actuator at a point of the skin, whichever the image shows.
  std::uint16_t at(std::uint32_t triangle, const glm::dvec2& texture_coordinate) const {
    return triangle_count == 0 ? at(texture_coordinate) : triangle < triangle_count ? actuator[triangle] : 0;
  }
};

/// A tEXt chunk of this keyword and text marks a PNG whose texels are triangles: without its sidecar it is refused, not
/// taken for an image in UV space.
inline constexpr std::string_view kMapKeyword = "Actuator map";
inline constexpr std::string_view kTriangleMap = "by triangle";

/// Reads a PNG of 8 or 16 bit grey. Without a sidecar, actuators 1 … n are the distinct non-zero greys in ascending
/// order. `sidecar_json` (may be empty) says which grey is which: {"actuators": [{"grey": 40, "name": "chest left",
/// "position_m": [0.08, 1.3, 0.12]}, …]}, in the order of their numbers; a grey in the image that it does not list is
/// an error. Name and position (three finite numbers) may be left out. With "triangles": N, the texels are the avatar's
/// triangles, and with "skin" only those of the avatar of this `skin_digest`. `name` stands in errors: no PNG,
/// truncated, colour or palette image, alpha channel, more than 65534 actuators, unusable sidecar, fewer texels than
/// triangles, triangles whose number is not given.
ActuatorMap parse_actuator_map(std::span<const std::byte> png, std::string_view sidecar_json, std::string_view name);

/// SHA-256 of the avatar's triangles and bind positions, 64 hexadecimal digits.
std::string skin_digest(const Avatar& avatar);

/// A map's two files.
struct ActuatorMapFiles {
  std::vector<std::byte> png;
  std::string json;                        ///< may be empty
  std::vector<std::string> warnings = {};  ///< about how they were made, one sentence each
};

/// The same for an avatar; its warnings begin with those of the files. Throws `Error` also where the texels are another
/// avatar's triangles.
ActuatorMap parse_actuator_map(const ActuatorMapFiles& files, const Avatar& avatar, std::string_view name);

/// Those that a trace carries; empty where it has none.
ActuatorMapFiles actuator_map_files(const TraceReader& trace);

/// Where the sidecar of a map in a PNG file is: the .json of the same name.
std::filesystem::path sidecar_path(std::filesystem::path map);

/// `map`: "none" (both are empty), "builtin", or a PNG file with its sidecar, if there is one. Throws `Error` where a
/// file cannot be read.
ActuatorMapFiles read_actuator_map_files(const std::string& map);

/// SHA-256 of the PNG and then the sidecar, 64 lower-case hexadecimal digits.
std::string sha256_of(const ActuatorMapFiles& files);

}  // namespace vestige
