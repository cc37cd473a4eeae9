#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <vector>

namespace vestige {

struct Avatar;
struct Animation;

/// A node relative to its parent: scale first, then rotation, then translation (glTF 2.0 §3.5.3). Single precision,
/// since that is what a trace stores: what is replayed is what was recorded, to the bit.
struct NodeLocal {
  glm::vec3 translation = glm::vec3(0);
  glm::quat rotation = glm::quat(1, 0, 0, 0);  ///< w, x, y, z; normalised in double when used
  glm::vec3 scale = glm::vec3(1);
};

/// All nodes at one instant, and where in the world the avatar's own frame stands (metres, double).
struct Pose {
  glm::dvec3 origin_m = glm::dvec3(0);
  std::vector<NodeLocal> nodes;  ///< one for each of Avatar::nodes
};

/// The pose that the file gives without any animation.
Pose rest_pose(const Avatar& avatar);

/// The animation at `time_s`, clamped to its keys (glTF 2.0, Appendix C); nodes without a channel keep their rest.
/// Interpolated in double, rounded once.
Pose sample_animation(const Avatar& avatar, const Animation& animation, double time_s);

/// What an avatar does at `time_s` while its animation loops; its rest pose where `animation` is null.
Pose looped_pose(const Avatar& avatar, const Animation* animation, double time_s);

/// World matrices of all nodes in double, relative to the pose's own `origin_m` (which is not added).
/// Precondition: pose.nodes.size() == avatar.nodes.size().
void world_matrices(const Avatar& avatar, const Pose& pose, std::vector<glm::dmat4>& out);

}  // namespace vestige
