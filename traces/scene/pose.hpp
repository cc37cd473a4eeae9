#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <vector>

namespace vestige {

struct Avatar;
struct Animation;

/// A node's transform relative to its parent: first scale, then rotation, then translation (glTF 2.0 §3.5.3). Numbers
/// are single precision as in a trace, so that a replay has the same bits as the recording.
struct NodeLocal {
  glm::vec3 translation = glm::vec3(0);
  glm::quat rotation = glm::quat(1, 0, 0, 0);  ///< w, x, y, z; normalised in double when used
  glm::vec3 scale = glm::vec3(1);
};

/// All nodes at one instant, and the world position of the avatar's own frame (metres, double).
struct Pose {
  glm::dvec3 origin_m = glm::dvec3(0);
  std::vector<NodeLocal> nodes;  ///< one for each of Avatar::nodes
};

/// Returns the pose of the file without any animation.
Pose rest_pose(const Avatar& avatar);

/// Returns the animation at `time_s`, clamped to its keys (glTF 2.0, Appendix C). Nodes without a channel keep their
/// rest transform. Values are interpolated in double and rounded once.
Pose sample_animation(const Avatar& avatar, const Animation& animation, double time_s);

/// Returns the avatar's pose at `time_s` while its animation loops, or its rest pose if `animation` is null.
Pose looped_pose(const Avatar& avatar, const Animation* animation, double time_s);

/// Returns in `out` the world matrices of all nodes, in double, relative to the pose's `origin_m` (which is not added).
/// Precondition: pose.nodes.size() == avatar.nodes.size().
void world_matrices(const Avatar& avatar, const Pose& pose, std::vector<glm::dmat4>& out);

}  // namespace vestige
