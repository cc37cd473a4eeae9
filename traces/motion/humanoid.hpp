#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "traces/scene/avatar.hpp"

namespace vestige {

/// The nodes of an avatar that are the bones of a human body. Keys are the names of Unity's HumanBodyBones ("Hips",
/// "LeftUpperArm"), which VRM and the VMC protocol share.
struct Humanoid {
  enum class Source { kVrm, kNames };
  /// The direction the avatar faces in its rest pose: -Z in VRM 0.x, otherwise +Z as glTF requires.
  enum class Facing { kPlusZ, kMinusZ };

  std::map<std::string, std::size_t, std::less<>> node_of;
  Source source = Source::kNames;
  Facing facing = Facing::kPlusZ;
  /// Invalid parts of the extension, which are left out, each with its field; the first 10.
  std::vector<std::string> problems;
};

/// Finds the bones by the extension VRM or VRMC_vrm of the file `glb`, otherwise by the nodes' names (body_roles.hpp).
/// May find none. Never fails, because `glb` was already parsed as `avatar`.
Humanoid find_humanoid(const Avatar& avatar, std::span<const std::byte> glb);

}  // namespace vestige
