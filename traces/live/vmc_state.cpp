#include "traces/live/vmc_state.hpp"

#include <fmt/format.h>

#include <cmath>
#include <glm/mat4x4.hpp>

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

/// Whether a message /VMC/Ext/OK says that there is a frame.
bool is_ready(const OscMessage& message) {
  const auto* value = message.arguments.empty() ? nullptr : std::get_if<std::int32_t>(&message.arguments[0]);
  return value == nullptr || *value != 0;
}

const std::string& text(const OscMessage& message) {
  const auto* value = message.arguments.empty() ? nullptr : std::get_if<std::string>(&message.arguments[0]);
  if (value == nullptr) throw Malformed(fmt::format("{}: its first argument is not a text", message.address));
  return *value;
}

}  // namespace

VmcState::VmcState(const Avatar& avatar, const glm::dvec3& origin_m, const Stance& stance)
    : avatar_(avatar),
      origin_m_(origin_m),
      stance_(stance),
      skeleton_(vmc_skeleton(avatar, "--avatar")),
      pose_(rest_pose(avatar)) {
  pose_.origin_m = origin_m;
  top_local_ = pose_.nodes[skeleton_.top];
}

VmcContent VmcState::check(std::span<const OscMessage> messages) const {
  VmcContent content;
  std::size_t colliders = colliders_.size();
  std::size_t markers = markers_.size();
  for (const OscMessage& message : messages) {
    if (message.address == "/VMC/Ext/Bone/Pos" || message.address == "/VMC/Ext/Root/Pos") {
      text(message);
      placement_of(message);
      content.pose = true;
    } else if (message.address == "/VMC/Ext/OK") {
      content.ends = content.ends || is_ready(message);
    } else if (message.address == "/vestige/collider") {
      id(message);
      for (std::size_t i = 1; i <= 3; ++i) number(message, i);
      radius(message);
      if (!colliders_.contains(id(message)) && ++colliders > kMostColliders)
        throw Malformed("there are already a million colliders");
      content.colliders = true;
    } else if (message.address == "/vestige/collider/remove" || message.address == "/vestige/teleport") {
      id(message);
      content.colliders = true;
    } else if (message.address == "/vestige/marker") {
      text(message);
      if (++markers > kMostMarkers) throw Malformed("there are already a thousand markers since the last frame");
    }
  }
  return content;
}

bool VmcState::take(std::span<const std::byte> datagram, const Admit& admit) {
  try {
    const std::vector<OscMessage> messages = decode_osc_packet(datagram);
    const VmcContent content = check(messages);  // all messages must be valid before one of them counts
    if (admit && !admit(content)) return false;
    bool changed = false;
    for (const OscMessage& message : messages) changed = apply(message) || changed;
    return changed;
  } catch (const Malformed& malformed) {
    ++malformed_;
    if (problems_.size() < kMostBadMessagesTold) problems_.emplace_back(malformed.what());
    return false;
  }
}

VmcPlacement VmcState::placement_of(const OscMessage& message) const {
  double values[7] = {};
  for (std::size_t i = 0; i < std::size(values); ++i) values[i] = number(message, i + 1);
  const auto [x, y, z, qx, qy, qz, qw] = values;
  VmcPlacement placement = from_unity({.position = {x, y, z}, .rotation = {qw, qx, qy, qz}}, skeleton_.facing);
  const double length = glm::length(placement.rotation);
  if (!(length > kShortestQuaternion))
    throw Malformed(fmt::format("{}: its rotation is a quaternion without length", message.address));
  placement.rotation /= length;
  return placement;
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
    if (removed_.erase(id(message)) > 0) teleported_.insert(id(message));
    return true;
  }
  if (message.address == "/vestige/collider/remove") {
    const bool was_there = colliders_.erase(id(message)) > 0;
    if (was_there) removed_.insert(id(message));
    return was_there;
  }
  if (message.address == "/vestige/teleport") {
    if (colliders_.contains(id(message))) teleported_.insert(id(message));
    return false;  // it says something of where the collider is said to be next
  }
  if (message.address == "/vestige/marker")
    markers_.push_back({.kind = RecordingNote::Kind::kMarker, .text = text(message)});
  return false;
}

bool VmcState::move_bone(const std::string& name, const VmcPlacement& placement) {
  const auto found = skeleton_.bones.find(name);
  if (found == skeleton_.bones.end()) {
    if (unknown_bones_.size() < kMostUnknownBones) unknown_bones_.insert(name);
    return false;
  }
  bones_.insert(name);
  const VmcBone& bone = found->second;
  NodeLocal& local = bone.node == skeleton_.top ? top_local_ : pose_.nodes[bone.node];
  local.rotation = glm::quat(bone.local_rotation(placement.rotation));
  if (name == "Hips")
    local.translation = glm::vec3(glm::dvec3(bone.parent_from_avatar * glm::dvec4(placement.position, 1)));
  return true;
}

void VmcState::show(TraceFrame& frame) {
  NodeLocal& top = pose_.nodes[skeleton_.top];
  top = top_local_;
  top.translation = glm::vec3(root_.position + root_.rotation * glm::dvec3(top_local_.translation));
  top.rotation = glm::quat(glm::normalize(root_.rotation * glm::normalize(glm::dquat(top_local_.rotation))));
  frame.poses.front() = pose_;
  move_to(stance_, avatar_, frame.poses.front());
  frame.colliders.clear();
  for (const auto& [id, collider] : colliders_) frame.colliders.push_back(collider);
  frame.teleported.assign(teleported_.begin(), teleported_.end());
  teleported_.clear();
}

void VmcState::remove_colliders() {
  for (const auto& [id, collider] : colliders_) removed_.insert(id);
  colliders_.clear();
}

}  // namespace vestige
