#include "traces/humanoid.hpp"

#include <array>
#include <cctype>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "traces/body_roles.hpp"
#include "traces/error.hpp"
#include "traces/glb_container.hpp"
#include "traces/gltf_report.hpp"

namespace vestige {

namespace {

using nlohmann::json;

/// Empty: Unity has no such bone.
std::string bone_name(const BodyRole& role) {
  static const std::map<BodyPart, const char*> names = {
      {BodyPart::kHips, "Hips"},         {BodyPart::kNeck, "Neck"},         {BodyPart::kHead, "Head"},
      {BodyPart::kJaw, "Jaw"},           {BodyPart::kEye, "Eye"},           {BodyPart::kShoulder, "Shoulder"},
      {BodyPart::kUpperArm, "UpperArm"}, {BodyPart::kLowerArm, "LowerArm"}, {BodyPart::kHand, "Hand"},
      {BodyPart::kUpperLeg, "UpperLeg"}, {BodyPart::kLowerLeg, "LowerLeg"}, {BodyPart::kFoot, "Foot"},
      {BodyPart::kToes, "Toes"},         {BodyPart::kThumb, "Thumb"},       {BodyPart::kIndex, "Index"},
      {BodyPart::kMiddle, "Middle"},     {BodyPart::kRing, "Ring"},         {BodyPart::kLittle, "Little"}};
  static constexpr std::array kSpine = {"Spine", "Chest", "UpperChest"};
  static constexpr std::array kPhalanges = {"Proximal", "Intermediate", "Distal"};
  const auto segment = static_cast<std::size_t>(role.segment);
  if (role.part == BodyPart::kSpine) return segment < kSpine.size() ? kSpine[segment] : "";
  std::string name = role.side == BodySide::kLeft ? "Left" : role.side == BodySide::kRight ? "Right" : "";
  name += names.at(role.part);
  if (role.part < BodyPart::kThumb || role.part > BodyPart::kLittle) return name;
  return segment >= 1 && segment <= kPhalanges.size() ? name + kPhalanges[segment - 1] : "";
}

/// VRM writes "leftUpperArm"; 1.0 names the thumb's bones differently from all others.
std::string unity_name(std::string name) {
  static const std::map<std::string, std::string, std::less<>> thumbs = {
      {"leftThumbMetacarpal", "LeftThumbProximal"},
      {"leftThumbProximal", "LeftThumbIntermediate"},
      {"rightThumbMetacarpal", "RightThumbProximal"},
      {"rightThumbProximal", "RightThumbIntermediate"},
  };
  if (const auto thumb = thumbs.find(name); thumb != thumbs.end()) return thumb->second;
  if (!name.empty()) name[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
  return name;
}

std::optional<std::size_t> node_index(const json& bone, std::size_t nodes) {
  if (!bone.is_object()) return {};
  const auto node = bone.find("node");
  if (node == bone.end() || !node->is_number_unsigned() || node->get<std::size_t>() >= nodes) return {};
  return node->get<std::size_t>();
}

const json* member(const json* object, const char* name) {
  if (object == nullptr || !object->is_object()) return nullptr;
  const auto found = object->find(name);
  return found == object->end() ? nullptr : &*found;
}

Humanoid by_vrm(const json& root, std::size_t nodes) {
  Humanoid humanoid;
  humanoid.source = Humanoid::Source::kVrm;
  const json* extensions = member(&root, "extensions");
  const json* bones = member(member(member(extensions, "VRMC_vrm"), "humanoid"), "humanBones");
  if (bones != nullptr && bones->is_object()) {
    for (const auto& [name, bone] : bones->items())
      if (const auto node = node_index(bone, nodes)) humanoid.node_of.emplace(unity_name(name), *node);
    return humanoid;
  }
  bones = member(member(member(extensions, "VRM"), "humanoid"), "humanBones");
  if (bones == nullptr || !bones->is_array()) return humanoid;
  humanoid.facing = Humanoid::Facing::kMinusZ;
  for (const json& bone : *bones) {
    const json* name = member(&bone, "bone");
    const auto node = node_index(bone, nodes);
    if (name == nullptr || !name->is_string() || !node) continue;
    std::string unity = name->get<std::string>();
    if (!unity.empty()) unity[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(unity[0])));
    humanoid.node_of.emplace(std::move(unity), *node);
  }
  return humanoid;
}

}  // namespace

Humanoid find_humanoid(const Avatar& avatar, std::span<const std::byte> glb) {
  gltf::Report report("avatar.glb");
  const json root = json::parse(gltf::split_glb(glb, report).json, nullptr, false);
  Humanoid humanoid = by_vrm(root, avatar.nodes.size());
  if (!humanoid.node_of.empty()) return humanoid;
  humanoid = {};
  const auto roles = body_roles(avatar);
  for (std::size_t i = 0; i < roles.size(); ++i) {
    std::string bone = roles[i] ? bone_name(*roles[i]) : "";
    if (!bone.empty()) humanoid.node_of.emplace(std::move(bone), i);
  }
  return humanoid;
}

}  // namespace vestige
