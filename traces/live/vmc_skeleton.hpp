#pragma once

#include <cstddef>
#include <functional>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <string>
#include <string_view>

#include "traces/scene/avatar.hpp"

namespace vestige {

/// Where a message of the VMC protocol puts a bone in its parent, or the root in the world. Position in metres; the
/// rotation has length 1.
struct VmcPlacement {
  glm::dvec3 position = glm::dvec3(0);
  glm::dquat rotation = glm::dquat(1, 0, 0, 0);
};

/// Converts from Unity's axes (left-handed, +Y up, +Z forward), in which messages are sent, to those of an avatar that
/// faces `facing`. Mirrors across x, which makes the axes those of an avatar that faces +Z, then turns to where the
/// avatar faces. Exact.
VmcPlacement from_unity(const VmcPlacement& sent, Facing facing);
/// Undoes `from_unity`.
VmcPlacement to_unity(const VmcPlacement& placement, Facing facing);

/// A bone of an avatar. VMC says its rotation in a skeleton whose bones have no rotation in the T-pose. Rotations and
/// positions here have the avatar's axes.
struct VmcBone {
  std::size_t node = 0;
  glm::dquat rest = glm::dquat(1, 0, 0, 0);         ///< the node's own rotation in the rest pose
  glm::dquat parent_rest = glm::dquat(1, 0, 0, 0);  ///< rotation of the node's parent in the rest pose
  glm::dmat4 avatar_from_parent = glm::dmat4(1);    ///< converts a position of the parent's frame at rest
  glm::dmat4 parent_from_avatar = glm::dmat4(1);    ///< its inverse

  /// Converts a rotation from a message to the node's own. Its length is 1.
  glm::dquat local_rotation(const glm::dquat& said) const;
  /// Undoes `local_rotation`. `local` has length 1.
  glm::dquat said_rotation(const glm::dquat& local) const;
};

/// What messages of the VMC protocol can move of an avatar.
struct VmcSkeleton {
  Facing facing = Facing::kPlusZ;
  std::map<std::string, VmcBone, std::less<>> bones;  ///< by their names in Unity's HumanBodyBones
  std::size_t top = 0;  ///< the outermost node above the hips, or above the first bone; the root moves it

  bool top_is_bone() const;
};

/// Throws `Error` if the avatar has no bone of a human body, or does not stand (`AvatarFacing::lies_deg`). `where`
/// begins the message.
VmcSkeleton vmc_skeleton(const Avatar& avatar, std::string_view where);

}  // namespace vestige
