#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "traces/scene/avatar.hpp"

namespace vestige {

/// Which of an avatar's nodes are the bones of a human body, by the names of Unity's HumanBodyBones ("Hips",
/// "LeftUpperArm"), which VRM and the VMC protocol share.
struct Humanoid {
  enum class Source { kVrm, kNames };
  /// Which way the avatar's face looks in its rest pose: VRM 0.x looks along -Z, all others along +Z as glTF asks.
  enum class Facing { kPlusZ, kMinusZ };

  std::map<std::string, std::size_t, std::less<>> node_of;
  Source source = Source::kNames;
  Facing facing = Facing::kPlusZ;
  /// What of the extension makes no sense and is left out, each with its field; the first 10.
  std::vector<std::string> problems;
};

/// By the extensions VRM or VRMC_vrm of its file `glb` where there is one, else by the nodes' names (body_roles.hpp).
/// May find none. Never fails: `glb` has been read as `avatar` before.
Humanoid find_humanoid(const Avatar& avatar, std::span<const std::byte> glb);

}  // namespace vestige
