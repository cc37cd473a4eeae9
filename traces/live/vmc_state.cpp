#include "traces/live/vmc_state.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <utility>

#include "traces/base/error.hpp"
#include "traces/mcap/decode.hpp"
#include "traces/scene/radius.hpp"
#include "traces/trace_file/trace_format.hpp"

namespace vestige {

namespace {

using mcap::Malformed;

constexpr std::size_t kMostBadMessagesTold = 10;
constexpr std::size_t kMostUnknownBones = 64;
constexpr std::size_t kMostColliders = 1'000'000;  // the limit of a scenario, too
constexpr std::size_t kMostMarkers = 1000;
constexpr double kShortestQuaternion = 1e-6;

double number(const OscMessage& message, std::size_t at) {
  if (at >= message.arguments.size()) throw Malformed(fmt::format("{} has too few arguments", message.address));
  double value = 0;
  if (const auto* single = std::get_if<float>(&message.arguments[at])) {
    value = double{*single};
  } else if (const auto* twice = std::get_if<double>(&message.arguments[at])) {
    value = *twice;
  } else {
    throw Malformed(fmt::format("{}: argument {} is not a float", message.address, at + 1));
  }
  if (!std::isfinite(value)) throw Malformed(fmt::format("{}: argument {} is not finite", message.address, at + 1));
  if (std::abs(value) > trace_format::kFarthest_m)
    throw Malformed(fmt::format("{}: argument {} is beyond {:g}", message.address, at + 1, trace_format::kFarthest_m));
  return value;
}

/// Returns the radius of a collider in metres; 0 if the message has none.
float radius(const OscMessage& message) {
  constexpr std::size_t kPlace = 4;
  if (message.arguments.size() <= kPlace) return 0;
  const double radius_m = number(message, kPlace);
  if (const std::string_view fault = radius_fault(radius_m); !fault.empty())
    throw Malformed(fmt::format("{}: its radius, {} m, {}", message.address, radius_m, fault));
  return static_cast<float>(radius_m);
}

std::uint32_t id(const OscMessage& message) {
  const auto* value = message.arguments.empty() ? nullptr : std::get_if<std::int32_t>(&message.arguments[0]);
  if (value == nullptr || *value < 0)
    throw Malformed(fmt::format("{}: its id is not a whole number from 0 up", message.address));
  return static_cast<std::uint32_t>(*value);
}

const std::string& text(const OscMessage& message) {
  const auto* value = message.arguments.empty() ? nullptr : std::get_if<std::string>(&message.arguments[0]);
  if (value == nullptr) throw Malformed(fmt::format("{}: its first argument is not a text", message.address));
  return *value;
}

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

VmcState::VmcState(const Avatar& avatar, const glm::dvec3& origin_m, const Stance& stance)
    : avatar_(avatar), origin_m_(origin_m), stance_(stance), pose_(rest_pose(avatar)), facing_(avatar.facing.axis) {
  if (avatar.humanoid.node_of.empty())
    throw Error("--avatar", "no joint is recognised as a bone of a human body, so no message can move the avatar",
                "use a VRM file, or name the joints as in Unity, Mixamo, Unreal or Blender");
  require_standing(avatar.facing, "--avatar");
  for (const NodeLocal& node : pose_.nodes) rest_.push_back(glm::normalize(glm::dquat(node.rotation)));
  pose_.origin_m = origin_m;
  std::vector<glm::dmat4> world;
  Pose at_zero = rest_pose(avatar);
  world_matrices(avatar, at_zero, world);
  const std::vector<glm::dquat> rotation = rest_rotations(avatar);
  for (const auto& [name, node] : avatar.humanoid.node_of) {
    Bone bone{.node = node};
    if (const int parent = avatar.nodes[node].parent; parent >= 0) {
      bone.parent_rest = rotation[static_cast<std::size_t>(parent)];
      bone.parent_from_avatar = glm::inverse(world[static_cast<std::size_t>(parent)]);
    }
    bone_of_.emplace(name, bone);
  }
  const auto hips = bone_of_.find("Hips");
  top_ = outermost(avatar, hips == bone_of_.end() ? bone_of_.begin()->second.node : hips->second.node);
  top_local_ = pose_.nodes[top_];
}

bool VmcState::take(std::span<const std::byte> datagram) {
  try {
    const std::vector<OscMessage> messages = decode_osc_packet(datagram);
    // All messages must be valid before one of them counts.
    std::size_t colliders = colliders_.size();
    std::size_t markers = markers_.size();
    for (const OscMessage& message : messages) {
      if (message.address == "/VMC/Ext/Bone/Pos" || message.address == "/VMC/Ext/Root/Pos") {
        text(message);
        placement_of(message);
      } else if (message.address == "/vestige/collider") {
        id(message);
        for (std::size_t i = 1; i <= 3; ++i) number(message, i);
        radius(message);
        if (!colliders_.contains(id(message)) && ++colliders > kMostColliders)
          throw Malformed("there are already a million colliders");
      } else if (message.address == "/vestige/collider/remove" || message.address == "/vestige/teleport") {
        id(message);
      } else if (message.address == "/vestige/marker") {
        text(message);
        if (++markers > kMostMarkers) throw Malformed("there are already a thousand markers since the last frame");
      }
    }
    bool changed = false;
    for (const OscMessage& message : messages) changed = apply(message) || changed;
    return changed;
  } catch (const Malformed& malformed) {
    ++malformed_;
    if (problems_.size() < kMostBadMessagesTold) problems_.emplace_back(malformed.what());
    return false;
  }
}

VmcState::Placement VmcState::placement_of(const OscMessage& message) const {
  double values[7] = {};
  for (std::size_t i = 0; i < std::size(values); ++i) values[i] = number(message, i + 1);
  const auto [x, y, z, qx, qy, qz, qw] = values;
  // Mirrored across x, which makes the axes those of an avatar that faces +Z; then turned to where the avatar faces.
  const glm::dvec3 axis = turned_from_front({qx, -qy, -qz}, facing_);
  const Placement placement = {.position = turned_from_front({-x, y, z}, facing_),
                               .rotation = glm::dquat(qw, axis.x, axis.y, axis.z)};
  const double length = glm::length(placement.rotation);
  if (!(length > kShortestQuaternion))
    throw Malformed(fmt::format("{}: its rotation is a quaternion without length", message.address));
  return {.position = placement.position, .rotation = placement.rotation / length};
}

bool VmcState::apply(const OscMessage& message) {
  if (message.address == "/VMC/Ext/Bone/Pos") return move_bone(text(message), placement_of(message));
  if (message.address == "/VMC/Ext/Root/Pos") {
    root_ = placement_of(message);
    return true;
  }
  if (message.address == "/vestige/collider") {
    const glm::dvec3 given(number(message, 1), number(message, 2), number(message, 3));
    colliders_[id(message)] = {id(message), origin_m_ + stance_.position_m + stance_.turned(given), radius(message)};
    return true;
  }
  if (message.address == "/vestige/collider/remove") return colliders_.erase(id(message)) > 0;
  if (message.address == "/vestige/teleport") {
    if (std::find(teleported_.begin(), teleported_.end(), id(message)) == teleported_.end() &&
        colliders_.contains(id(message)))
      teleported_.push_back(id(message));
    return true;
  }
  if (message.address == "/vestige/marker")
    markers_.push_back({.kind = RecordingNote::Kind::kMarker, .text = text(message)});
  return false;
}

bool VmcState::move_bone(const std::string& name, const Placement& placement) {
  const auto found = bone_of_.find(name);
  if (found == bone_of_.end()) {
    if (unknown_bones_.size() < kMostUnknownBones) unknown_bones_.insert(name);
    return false;
  }
  bones_.insert(name);
  const Bone& bone = found->second;
  NodeLocal& local = bone.node == top_ ? top_local_ : pose_.nodes[bone.node];
  local.rotation = glm::quat(
      glm::normalize(glm::conjugate(bone.parent_rest) * placement.rotation * bone.parent_rest * rest_[bone.node]));
  if (name == "Hips")
    local.translation = glm::vec3(glm::dvec3(bone.parent_from_avatar * glm::dvec4(placement.position, 1)));
  return true;
}

void VmcState::show(TraceFrame& frame) {
  NodeLocal& top = pose_.nodes[top_];
  top = top_local_;
  top.translation = glm::vec3(root_.position + root_.rotation * glm::dvec3(top_local_.translation));
  top.rotation = glm::quat(glm::normalize(root_.rotation * glm::normalize(glm::dquat(top_local_.rotation))));
  frame.poses.front() = pose_;
  move_to(stance_, avatar_, frame.poses.front());
  frame.colliders.clear();
  for (const auto& [id, collider] : colliders_) frame.colliders.push_back(collider);
  frame.teleported = std::exchange(teleported_, {});
}

}  // namespace vestige
