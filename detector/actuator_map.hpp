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

#include "detector/firing.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige {

struct RecordedPerson;

/// The actuator ID map (HAVE 2010 §III.B): an image in which each grey level is one actuator and black fires nothing.
/// The map stores actuator numbers 1 … actuator_count; 0 means no actuator.
struct ActuatorMap {
  /// 0 if the image lies in the avatar's UV space. Otherwise texel k (row by row) belongs to the avatar's triangle k,
  /// and this is the number of triangles. That layout serves avatars whose texture coordinates cannot tell places of
  /// the skin apart.
  std::size_t triangle_count = 0;
  std::uint32_t width = 1;
  std::uint32_t height = 1;
  std::vector<std::uint16_t> actuator = {0};  ///< width * height, row 0 at the top
  std::size_t actuator_count = 0;
  std::vector<std::string> names;  ///< one for each actuator
  /// One for each actuator: the middle of its region on the skin in the bind pose, in metres. Empty if the sidecar does
  /// not give it.
  std::vector<std::optional<glm::dvec3>> position_m;
  Firing firing;                      ///< what the regions make vibrate: each its own actuator, as a rule
  std::optional<Facing> facing;       ///< of the avatar at rest when the map was made; empty if the sidecar is silent
  std::string skin_digest;            ///< `skin_digest` of the avatar that owns the triangles; may be empty
  std::vector<std::string> warnings;  ///< one sentence each

  /// Returns the actuator under a texture coordinate: nearest texel floor(frac(u) W), floor(frac(v) H), origin
  /// top-left, wrapped (detector/CONTRACT.md, 8). Returns 0 if the coordinate is not finite.
  std::uint16_t at(const glm::dvec2& texture_coordinate) const;
  /// Returns the actuator at a point of the skin, for either layout of the image.
  std::uint16_t at(std::uint32_t triangle, const glm::dvec2& texture_coordinate) const {
    return triangle_count == 0 ? at(texture_coordinate) : triangle < triangle_count ? actuator[triangle] : 0;
  }
};

/// A tEXt chunk with this keyword and text marks a PNG whose texels are triangles. The parser refuses such a PNG if its
/// sidecar is missing, instead of reading it as an image in UV space.
inline constexpr std::string_view kMapKeyword = "Actuator map";
inline constexpr std::string_view kTriangleMap = "by triangle";

/// Reads a PNG of 8 or 16 bit grey. Without a sidecar, actuators 1 … n are the distinct non-zero greys in ascending
/// order. `sidecar_json` (may be empty) assigns the greys to actuators, in the order of the actuator numbers:
/// {"actuators": [{"grey": 40, "name": "chest left", "position_m": [0.08, 1.3, 0.12]}, …]}. A grey that the image uses
/// and the sidecar does not list is an error. Name and position (three finite numbers) are optional.
///
/// "fires" lets regions fire other actuators than their own (`Firing`).
///
/// "facing" ("+z", "+x", "-z" or "-x") tells which way the avatar looked when the map was made.
///
/// With "triangles": N, the texels are the avatar's triangles. With "skin" as well, the map fits only the avatar with
/// this `skin_digest`.
///
/// Throws `Error`, which quotes `name`, for: no PNG, a truncated file, a colour or palette image, an alpha channel,
/// more than 65534 actuators, an unusable sidecar, fewer texels than triangles, and a triangle map whose sidecar does
/// not give the number of triangles.
ActuatorMap parse_actuator_map(std::span<const std::byte> png, std::string_view sidecar_json, std::string_view name);

/// Returns the SHA-256 of the avatar's triangles and bind positions, as 64 hexadecimal digits.
std::string skin_digest(const Avatar& avatar);

/// The two files of a map.
struct ActuatorMapFiles {
  std::vector<std::byte> png;
  std::string json;                        ///< may be empty
  std::vector<std::string> warnings = {};  ///< about how the files were made, one sentence each
};

/// As above, for an avatar. The warnings begin with those of the files. Throws `Error` also if the texels are another
/// avatar's triangles.
ActuatorMap parse_actuator_map(const ActuatorMapFiles& files, const Avatar& avatar, std::string_view name);

/// Returns the map files that a trace carries for a person; they are empty if the person has no map.
ActuatorMapFiles actuator_map_files(const RecordedPerson& person);

/// Returns the path of the sidecar for a map in a PNG file: the same name with .json.
std::filesystem::path sidecar_path(std::filesystem::path map);

/// Returns `map`. If it is empty, returns "builtin" for the built-in avatar and "none" for any other.
std::string map_or_default(const std::string& map, const std::string& avatar);

/// `map` is "none" (both files are empty), "builtin", or a PNG file; its sidecar is read if it exists. Throws `Error`
/// if a file cannot be read.
ActuatorMapFiles read_actuator_map_files(const std::string& map);

/// Returns the SHA-256 of the PNG followed by the sidecar, as 64 lower-case hexadecimal digits.
std::string sha256_of(const ActuatorMapFiles& files);

}  // namespace vestige
