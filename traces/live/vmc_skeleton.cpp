#include "traces/live/vmc_skeleton.hpp"

#include <algorithm>
#include <glm/mat3x3.hpp>
#include <vector>

#include "traces/base/error.hpp"

namespace vestige {

namespace {

/// Returns the rotations of all nodes in the rest pose, relative to the avatar.
std::vector<glm::dquat> rest_rotations(const Avatar& avatar) {
  std::vector<glm::dquat> world(avatar.nodes.size(), glm::dquat(1, 0, 0, 0));
  for (const int index : avatar.node_order) {
    const auto i = static_cast<std::size_t>(index);
    const Node& node = avatar.nodes[i];
    glm::dquat local(node.rest.rotation);
    if (node.fixed_matrix) {
      const glm::dmat4& matrix = *node.fixed_matrix;
      local = glm::quat_cast(glm::dmat3(glm::normalize(glm::dvec3(matrix[0])), glm::normalize(glm::dvec3(matrix[1])),
                                        glm::normalize(glm::dvec3(matrix[2]))));
    }
    const glm::dquat parent = node.parent < 0 ? glm::dquat(1, 0, 0, 0) : world[static_cast<std::size_t>(node.parent)];
    world[i] = glm::normalize(parent * glm::normalize(local));
  }
  return world;
}

std::size_t outermost(const Avatar& avatar, std::size_t node) {
  while (avatar.nodes[node].parent >= 0) node = static_cast<std::size_t>(avatar.nodes[node].parent);
  return node;
}

}  // namespace

VmcPlacement from_unity(const VmcPlacement& sent, Facing facing) {
  const glm::dvec3& p = sent.position;
  const glm::dquat& q = sent.rotation;
  const glm::dvec3 axis = turned_from_front({q.x, -q.y, -q.z}, facing);
  return {.position = turned_from_front({-p.x, p.y, p.z}, facing), .rotation = glm::dquat(q.w, axis.x, axis.y, axis.z)};
}

VmcPlacement to_unity(const VmcPlacement& placement, Facing facing) {
  const glm::dquat& q = placement.rotation;
  const glm::dvec3 p = turned_to_front(placement.position, facing);
  const glm::dvec3 axis = turned_to_front({q.x, q.y, q.z}, facing);
  return {.position = {-p.x, p.y, p.z}, .rotation = glm::dquat(q.w, axis.x, -axis.y, -axis.z)};
}

glm::dquat VmcBone::local_rotation(const glm::dquat& said) const {
  return glm::normalize(glm::conjugate(parent_rest) * said * parent_rest * rest);
}

glm::dquat VmcBone::said_rotation(const glm::dquat& local) const {
  return glm::normalize(parent_rest * local * glm::conjugate(rest) * glm::conjugate(parent_rest));
}

bool VmcSkeleton::top_is_bone() const {
  return std::ranges::any_of(bones, [this](const auto& bone) { return bone.second.node == top; });
}

VmcSkeleton vmc_skeleton(const Avatar& avatar, std::string_view where) {
  if (avatar.humanoid.node_of.empty())
    throw Error(where, "no joint is recognised as a bone of a human body, so no message can move the avatar",
                "use a VRM file, or name the joints as in Unity, Mixamo, Unreal or Blender");
  require_standing(avatar.facing, where);
  const Pose rest = rest_pose(avatar);
  std::vector<glm::dmat4> world;
  world_matrices(avatar, rest, world);
  const std::vector<glm::dquat> rotation = rest_rotations(avatar);
  VmcSkeleton skeleton = {.facing = avatar.facing.axis, .bones = {}};
  for (const auto& [name, node] : avatar.humanoid.node_of) {
    VmcBone bone = {.node = node, .rest = glm::normalize(glm::dquat(rest.nodes[node].rotation))};
    if (avatar.nodes[node].parent >= 0) {
      const auto parent = static_cast<std::size_t>(avatar.nodes[node].parent);
      bone.parent_rest = rotation[parent];
      bone.avatar_from_parent = world[parent];
      bone.parent_from_avatar = glm::inverse(world[parent]);
    }
    skeleton.bones.emplace(name, bone);
  }
  const auto hips = skeleton.bones.find("Hips");
  skeleton.top = outermost(avatar, (hips == skeleton.bones.end() ? skeleton.bones.begin() : hips)->second.node);
  return skeleton;
}

}  // namespace vestige
