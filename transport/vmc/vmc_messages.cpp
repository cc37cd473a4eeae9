#include "transport/vmc/vmc_messages.hpp"

#include <string>

#include "transport/sinks/osc_message.hpp"

namespace vestige {

namespace {

OscBytes placement_message(const char* address, const std::string& name, const VmcPlacement& placement) {
  const glm::dvec3& p = placement.position;
  const glm::dquat& q = placement.rotation;
  OscMessageBuilder message;
  message.add(name);
  for (const double value : {p.x, p.y, p.z, q.x, q.y, q.z, q.w}) message.add(static_cast<float>(value));
  return message.bytes(address);
}

glm::dquat rotation_of(const NodeLocal& node) {
  return glm::normalize(glm::dquat(node.rotation));
}

/// Returns where the root has to be for the skeleton's top to be where the pose has it.
VmcPlacement root_of(const VmcSkeleton& skeleton, const Avatar& avatar, const Pose& pose) {
  const NodeLocal& top = pose.nodes[skeleton.top];
  const NodeLocal& rest = avatar.nodes[skeleton.top].rest;
  VmcPlacement root;
  // A bone's message says its rotation; that of the hips also says its translation.
  if (!skeleton.top_is_bone()) root.rotation = rotation_of(top) * glm::conjugate(rotation_of(rest));
  const auto hips = skeleton.bones.find("Hips");
  const bool hips_say_it = hips != skeleton.bones.end() && hips->second.node == skeleton.top;
  const glm::dvec3 without_root(hips_say_it ? top.translation : rest.translation);
  root.position = pose.origin_m + glm::dvec3(top.translation) - root.rotation * without_root;
  return root;
}

}  // namespace

std::vector<OscBytes> pose_messages(const VmcSkeleton& skeleton, const Avatar& avatar, const Pose& pose) {
  std::vector<OscBytes> messages;
  messages.reserve(skeleton.bones.size() + 1);
  const VmcPlacement root = root_of(skeleton, avatar, pose);
  messages.push_back(placement_message("/VMC/Ext/Root/Pos", "root", to_unity(root, skeleton.facing)));
  for (const auto& [name, bone] : skeleton.bones) {
    const NodeLocal& local = pose.nodes[bone.node];
    const VmcPlacement said = {
        .position = glm::dvec3(bone.avatar_from_parent * glm::dvec4(glm::dvec3(local.translation), 1)),
        .rotation = bone.said_rotation(rotation_of(local))};
    messages.push_back(placement_message("/VMC/Ext/Bone/Pos", name, to_unity(said, skeleton.facing)));
  }
  return messages;
}

std::vector<OscBytes> end_of_frame(double time_s) {
  OscMessageBuilder time;
  OscMessageBuilder ready;
  time.add(static_cast<float>(time_s));
  ready.add(std::int32_t{1});
  return {time.bytes("/VMC/Ext/T"), ready.bytes("/VMC/Ext/OK")};
}

OscBytes not_ready_message() {
  OscMessageBuilder message;
  return message.add(std::int32_t{0}).bytes("/VMC/Ext/OK");
}

OscBytes collider_message(const ColliderSample& collider) {
  OscMessageBuilder message;
  message.add(static_cast<std::int32_t>(collider.id));
  for (int axis = 0; axis < 3; ++axis) message.add(collider.position_m[axis]);
  if (collider.radius_m != 0) message.add(double{collider.radius_m});
  return message.bytes("/vestige/collider");
}

OscBytes removal_message(std::uint32_t id) {
  OscMessageBuilder message;
  return message.add(static_cast<std::int32_t>(id)).bytes("/vestige/collider/remove");
}

OscBytes teleport_message(std::uint32_t id) {
  OscMessageBuilder message;
  return message.add(static_cast<std::int32_t>(id)).bytes("/vestige/teleport");
}

}  // namespace vestige
