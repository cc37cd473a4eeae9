// The built-in avatar as other programs would write it: other names of joints, other poses, VRM.

#pragma once

#include <functional>
#include <glm/gtc/quaternion.hpp>
#include <map>

#include "tests/support/made/edited_glb.hpp"
#include "traces/scene/builtin_avatar.hpp"

namespace vestige::test {

/// The joints of the built-in avatar: those of the trunk, and those of each side without "_left".
inline const std::vector<std::string>& trunk_joints() {
  static const std::vector<std::string> names = {"pelvis", "lumbar_spine", "thoracic_spine", "neck", "head"};
  return names;
}
inline const std::vector<std::string>& side_joints() {
  static const std::vector<std::string> names = {"clavicle", "upper_arm", "forearm", "hand",
                                                 "thigh",    "shin",      "foot",    "toes"};
  return names;
}

/// What a program calls the joints, in the orders above. `side` gets "l" or "r" and the name.
struct NamesOfJoints {
  std::vector<std::string> trunk;
  std::vector<std::string> sides;
  std::function<std::string(bool is_left, const std::string&)> side;
};

inline nlohmann::json& node_named(nlohmann::json& json, const std::string& name) {
  for (nlohmann::json& node : json["nodes"])
    if (node.value("name", "") == name) return node;
  throw std::runtime_error("no node " + name);
}

inline void rename_joints(nlohmann::json& json, const NamesOfJoints& names) {
  for (std::size_t i = 0; i < names.trunk.size(); ++i) node_named(json, trunk_joints()[i])["name"] = names.trunk[i];
  for (std::size_t i = 0; i < names.sides.size(); ++i)
    for (const bool is_left : {true, false})
      node_named(json, side_joints()[i] + (is_left ? "_left" : "_right"))["name"] = names.side(is_left, names.sides[i]);
}

/// Turns a joint at rest about an axis of its parent; its skin follows.
inline void turn_joint(nlohmann::json& json, const std::string& name, double degrees, const glm::dvec3& axis) {
  nlohmann::json& node = node_named(json, name);
  const auto r = node.value("rotation", std::array<double, 4>{0, 0, 0, 1});
  const glm::dquat q = glm::angleAxis(glm::radians(degrees), axis) * glm::dquat(r[3], r[0], r[1], r[2]);
  node["rotation"] = {q.x, q.y, q.z, q.w};
}

/// Adds the table of bones of VRM 0.x or 1.0, and takes the joints' names away, so that only the table tells.
inline void make_vrm(nlohmann::json& json, bool is_vrm0) {
  const std::vector<std::string> trunk = {"hips", "spine", "chest", "neck", "head"};
  const std::vector<std::string> sides = {"Shoulder", "UpperArm", "LowerArm", "Hand",
                                          "UpperLeg", "LowerLeg", "Foot",     "Toes"};
  std::map<std::string, std::string> bone_of;
  for (std::size_t i = 0; i < trunk.size(); ++i) bone_of[trunk_joints()[i]] = trunk[i];
  for (std::size_t i = 0; i < sides.size(); ++i) {
    bone_of[side_joints()[i] + "_left"] = "left" + sides[i];
    bone_of[side_joints()[i] + "_right"] = "right" + sides[i];
  }
  nlohmann::json bones = is_vrm0 ? nlohmann::json::array() : nlohmann::json::object();
  for (std::size_t i = 0; i < json["nodes"].size(); ++i) {
    const auto bone = bone_of.find(json["nodes"][i].value("name", ""));
    if (bone == bone_of.end()) continue;
    json["nodes"][i]["name"] = "骨" + std::to_string(i);
    if (is_vrm0)
      bones.push_back({{"bone", bone->second}, {"node", i}});
    else
      bones[bone->second] = {{"node", i}};
  }
  const char* name = is_vrm0 ? "VRM" : "VRMC_vrm";
  json["extensionsUsed"].push_back(name);
  json["extensions"][name] = {{"humanoid", {{"humanBones", bones}}}};
}

/// Returns avatars by name. Each faces +z, but "VRM 0.x", which faces -z.
inline std::map<std::string, std::vector<std::byte>> made_avatars() {
  using json = nlohmann::json;
  const auto word = [](const char* left, const char* right, bool before) {
    return [=](bool is_left, const std::string& name) {
      return before ? (is_left ? left : right) + name : name + (is_left ? left : right);
    };
  };
  const std::map<std::string, NamesOfJoints> names = {
      {"Mixamo",
       {{"mixamorig:Hips", "mixamorig:Spine", "mixamorig:Spine1", "mixamorig:Neck", "mixamorig:Head"},
        {"Shoulder", "Arm", "ForeArm", "Hand", "UpLeg", "Leg", "Foot", "ToeBase"},
        word("mixamorig:Left", "mixamorig:Right", true)}},
      {"Unreal",
       {{"pelvis", "spine_01", "spine_02", "neck_01", "head"},
        {"clavicle", "upperarm", "lowerarm", "hand", "thigh", "calf", "foot", "ball"},
        word("_l", "_r", false)}},
      {"Biped",
       {{"Bip01 Pelvis", "Bip01 Spine", "Bip01 Spine1", "Bip01 Neck", "Bip01 Head"},
        {"Clavicle", "UpperArm", "Forearm", "Hand", "Thigh", "Calf", "Foot", "Toe0"},
        word("Bip01 L ", "Bip01 R ", true)}},
      {"Blender",
       {{"hips", "spine", "chest", "neck", "head"},
        {"shoulder", "upper_arm", "forearm", "hand", "thigh", "shin", "foot", "toe"},
        word(".L", ".R", false)}},
      {"Unity",
       {{"Hips", "Spine", "Chest", "Neck", "Head"},
        {"Shoulder", "UpperArm", "LowerArm", "Hand", "UpperLeg", "LowerLeg", "Foot", "Toes"},
        word("Left", "Right", true)}},
      {"CMU",
       {{"Hips", "LowerBack", "Spine", "Neck", "Head"},
        {"Shoulder", "Arm", "ForeArm", "Hand", "UpLeg", "Leg", "Foot", "ToeBase"},
        word("Left", "Right", true)}},
      {"MakeHuman",
       {{"root", "spine05", "spine02", "neck01", "head"},
        {"clavicle", "upperarm01", "lowerarm01", "wrist", "upperleg01", "lowerleg01", "foot", "toe1-1"},
        word(".L", ".R", false)}},
      {"VRoid",
       {{"J_Bip_C_Hips", "J_Bip_C_Spine", "J_Bip_C_Chest", "J_Bip_C_Neck", "J_Bip_C_Head"},
        {"Shoulder", "UpperArm", "LowerArm", "Hand", "UpperLeg", "LowerLeg", "Foot", "ToeBase"},
        word("J_Bip_L_", "J_Bip_R_", true)}}};
  const std::vector<std::byte> mannequin = builtin_avatar_glb();
  std::map<std::string, std::vector<std::byte>> made;
  for (const auto& [program, its] : names)
    made[program] = edited_glb(mannequin, [&its = its](json& file) { rename_joints(file, its); });
  made["VRM 1.0"] = edited_glb(mannequin, [](json& file) { make_vrm(file, false); });
  made["VRM 0.x"] = edited_glb(turned_glb(mannequin, 2), [](json& file) { make_vrm(file, true); });
  made["a child"] = edited_glb(mannequin, [](json& file) { hang_below(file, {{"scale", {0.6, 0.6, 0.6}}}); });
  made["arms hang"] = edited_glb(mannequin, [](json& file) {
    turn_joint(file, "upper_arm_left", -60, {0, 0, 1});
    turn_joint(file, "upper_arm_right", 60, {0, 0, 1});
  });
  made["sits"] = edited_glb(mannequin, [](json& file) {
    for (const char* side : {"_left", "_right"}) {
      turn_joint(file, std::string("thigh") + side, -90, {1, 0, 0});
      turn_joint(file, std::string("shin") + side, 90, {1, 0, 0});
    }
  });
  made["no toes"] = edited_glb(mannequin, [](json& file) {
    for (const char* side : {"_left", "_right"}) node_named(file, std::string("toes") + side)["name"] = "end";
  });
  return made;
}

}  // namespace vestige::test
