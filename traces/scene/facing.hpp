#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vestige {

/// The axis that an avatar looks along in its rest pose; +Y is up. Each is a quarter turn to the left of the one
/// before.
enum class Facing { kPlusZ, kPlusX, kMinusZ, kMinusX };

/// The names of the axes in flags and files, in the order of `Facing`.
inline constexpr std::array<std::string_view, 4> kFacingNames = {"+z", "+x", "-z", "-x"};

inline std::string_view to_string(Facing facing) {
  return kFacingNames[static_cast<std::size_t>(facing)];
}

/// Returns nothing if `name` is not one of `kFacingNames`.
std::optional<Facing> facing_named(std::string_view name);

/// Returns the axis as a unit vector.
glm::dvec3 forward_of(Facing facing);

/// Returns the direction in front of a body whose left is this horizontal direction.
inline glm::dvec3 forward_from_left(const glm::dvec3& left) {
  return {-left.z, 0, left.x};
}

/// Returns the axis nearest to a direction, whose height does not count.
Facing nearest_facing(const glm::dvec3& direction);

/// Turns a place or a direction about +Y as if the avatar looked along +z: +x is then its left. Exact: components swap
/// and change their signs.
inline glm::dvec3 turned_to_front(const glm::dvec3& p, Facing facing) {
  switch (facing) {
    case Facing::kPlusX:
      return {-p.z, p.y, p.x};
    case Facing::kMinusZ:
      return {-p.x, p.y, -p.z};
    case Facing::kMinusX:
      return {p.z, p.y, -p.x};
    case Facing::kPlusZ:
      break;
  }
  return p;
}

/// Undoes `turned_to_front`.
inline glm::dvec3 turned_from_front(const glm::dvec3& p, Facing facing) {
  switch (facing) {
    case Facing::kPlusX:
      return {p.z, p.y, -p.x};
    case Facing::kMinusZ:
      return {-p.x, p.y, -p.z};
    case Facing::kMinusX:
      return {-p.z, p.y, p.x};
    case Facing::kPlusZ:
      break;
  }
  return p;
}

/// Which way an avatar looks, and what tells it.
struct AvatarFacing {
  enum class By {
    kSides,    ///< the joints named left lie on its left
    kFeet,     ///< the feet point forward
    kVrm,      ///< the version of VRM
    kAssumed,  ///< nothing tells: +z, as glTF requires (glTF 2.0 §3.4)
    kMap,      ///< the actuator map records it
    kTrace,    ///< the trace records it
    kAsked,    ///< the user
  };
  Facing axis = Facing::kPlusZ;
  By by = By::kAssumed;
  /// The direction from the joints named right to those named left: horizontal, length 1. Empty if no names tell it.
  std::optional<glm::dvec3> left;
  /// A clause if the names contradict each other, the feet or VRM, or if nothing tells. Empty otherwise.
  std::string doubt;
  /// The angle from +Y to the direction from hips to head in degrees, if the avatar does not stand (find_facing.hpp).
  /// It then has no left and no front, whatever `axis` says. Empty if it stands, or if its bones do not tell.
  std::optional<double> lies_deg;
};

/// Takes an axis that is recorded or asked for, in place of the one that was found. A body that lies still lies.
inline void set_facing(AvatarFacing& facing, Facing axis, AvatarFacing::By by) {
  facing.axis = axis;
  facing.by = by;
  facing.doubt.clear();
}

/// Takes the text that a trace records as its facing. An empty one changes nothing. One that names no axis is a doubt.
void take_recorded_facing(AvatarFacing& facing, std::string_view recorded);

/// Returns a clause that says that the avatar does not stand, and how far it leans. Precondition: `facing.lies_deg`.
std::string describe_lying(const AvatarFacing& facing);

/// Throws `Error` if the avatar does not stand. `where` begins the message.
void require_standing(const AvatarFacing& facing, std::string_view where);

/// "sides", "feet", "vrm", "assumed", "map", "trace", "asked".
std::string_view to_string(AvatarFacing::By by);

/// Returns what tells the facing: "by its left and right joints", ….
std::string_view in_words(AvatarFacing::By by);

/// Decides which way an avatar faces. The axis that is asked for counts first, then what tells the facing already, then
/// the map. `asked` is one of `kFacingNames`; any other text asks for nothing. `of_map` is empty if the map does not
/// say it. Returns warnings: the avatar's sides contradict the axis that is asked for, the avatar does not stand, or
/// there is a doubt, which --facing ends. `name` is the avatar's name in them.
std::vector<std::string> settle_facing(AvatarFacing& facing, std::string_view asked, std::optional<Facing> of_map,
                                       std::string_view name);

/// The names of an avatar and its map in errors and warnings.
struct SceneNames {
  std::string avatar;
  std::string map;
};

/// Returns a warning if the map was made for another facing than the avatar's, which something tells. Otherwise returns
/// an empty text. Where the verb has --facing, `kOrSetFacing` ends the warning.
std::string other_facing(const AvatarFacing& facing, std::optional<Facing> of_map, const SceneNames& names);
inline constexpr const char* kOrSetFacing = ", or set --facing";

}  // namespace vestige
