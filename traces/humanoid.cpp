#include "traces/humanoid.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "traces/error.hpp"
#include "traces/glb_container.hpp"
#include "traces/gltf_report.hpp"

namespace vestige {

namespace {

using nlohmann::json;

struct Alias {
  std::string_view joint;  ///< lower case, letters and digits only, without its side
  std::string_view bone;
};

constexpr std::array kMiddleBones = {
    Alias{"hips", "Hips"},
    Alias{"hip", "Hips"},
    Alias{"pelvis", "Hips"},
    Alias{"spine", "Spine"},
    Alias{"spine01", "Spine"},
    Alias{"lumbarspine", "Spine"},
    Alias{"spine1", "Chest"},
    Alias{"spine02", "Chest"},
    Alias{"chest", "Chest"},
    Alias{"thoracicspine", "Chest"},
    Alias{"spine2", "UpperChest"},
    Alias{"spine03", "UpperChest"},
    Alias{"upperchest", "UpperChest"},
    Alias{"neck", "Neck"},
    Alias{"neck01", "Neck"},
    Alias{"head", "Head"},
    Alias{"jaw", "Jaw"},
};

constexpr std::array kSideBones = {
    Alias{"shoulder", "Shoulder"}, Alias{"clavicle", "Shoulder"}, Alias{"collar", "Shoulder"},
    Alias{"upperarm", "UpperArm"}, Alias{"arm", "UpperArm"},      Alias{"forearm", "LowerArm"},
    Alias{"lowerarm", "LowerArm"}, Alias{"hand", "Hand"},         Alias{"wrist", "Hand"},
    Alias{"upperleg", "UpperLeg"}, Alias{"upleg", "UpperLeg"},    Alias{"thigh", "UpperLeg"},
    Alias{"lowerleg", "LowerLeg"}, Alias{"leg", "LowerLeg"},      Alias{"shin", "LowerLeg"},
    Alias{"calf", "LowerLeg"},     Alias{"foot", "Foot"},         Alias{"ankle", "Foot"},
    Alias{"toes", "Toes"},         Alias{"toe", "Toes"},          Alias{"toebase", "Toes"},
    Alias{"ball", "Toes"},         Alias{"eye", "Eye"},
};

constexpr std::array kFingers = {Alias{"thumb", "Thumb"}, Alias{"index", "Index"},   Alias{"middle", "Middle"},
                                 Alias{"ring", "Ring"},   Alias{"little", "Little"}, Alias{"pinky", "Little"}};
constexpr std::array kPhalanges = {
    Alias{"1", "Proximal"},     Alias{"01", "Proximal"},     Alias{"proximal", "Proximal"},
    Alias{"2", "Intermediate"}, Alias{"02", "Intermediate"}, Alias{"intermediate", "Intermediate"},
    Alias{"3", "Distal"},       Alias{"03", "Distal"},       Alias{"distal", "Distal"},
};

template <typename Aliases>
std::string_view find(const Aliases& aliases, std::string_view joint) {
  const auto found = std::find_if(aliases.begin(), aliases.end(), [&](const Alias& a) { return a.joint == joint; });
  return found == aliases.end() ? std::string_view() : found->bone;
}

std::string finger_bone(std::string_view joint) {
  if (joint.starts_with("hand")) joint.remove_prefix(4);
  for (const Alias& finger : kFingers) {
    if (!joint.starts_with(finger.joint)) continue;
    const std::string_view phalanx = find(kPhalanges, joint.substr(finger.joint.size()));
    if (!phalanx.empty()) return std::string(finger.bone) + std::string(phalanx);
  }
  return {};
}

/// The words of a name: "mixamorig:LeftUpLeg" is "left", "up", "leg"; what stands before a colon is a prefix.
std::vector<std::string> words_of(std::string_view name) {
  if (const std::size_t colon = name.rfind(':'); colon != std::string_view::npos) name.remove_prefix(colon + 1);
  std::vector<std::string> words;
  bool in_word = false;
  char before = 0;
  for (const char letter : name) {
    const auto code = static_cast<unsigned char>(letter);
    const bool begins = std::isupper(code) != 0 && std::islower(static_cast<unsigned char>(before)) != 0;
    if (std::isalnum(code) == 0) {
      in_word = false;
    } else {
      if (!in_word || begins) words.emplace_back();
      words.back() += static_cast<char>(std::tolower(code));
      in_word = true;
    }
    before = letter;
  }
  return words;
}

/// Takes the word that says the side away; empty: there is none.
std::string take_side(std::vector<std::string>& words) {
  for (auto word = words.begin(); word != words.end(); ++word) {
    const bool left = *word == "left" || *word == "l";
    if (!left && *word != "right" && *word != "r") continue;
    words.erase(word);
    return left ? "Left" : "Right";
  }
  return {};
}

/// VRM writes "leftUpperArm"; 1.0 names the thumb's bones differently from all others.
std::string unity_name(std::string name) {
  static const std::map<std::string, std::string, std::less<>> kThumbs = {
      {"leftThumbMetacarpal", "LeftThumbProximal"},
      {"leftThumbProximal", "LeftThumbIntermediate"},
      {"rightThumbMetacarpal", "RightThumbProximal"},
      {"rightThumbProximal", "RightThumbIntermediate"},
  };
  if (const auto thumb = kThumbs.find(name); thumb != kThumbs.end()) return thumb->second;
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

std::string humanoid_bone(std::string_view joint_name) {
  std::vector<std::string> words = words_of(joint_name);
  const std::string side = take_side(words);
  std::string joint;
  for (const std::string& word : words) joint += word;
  if (side.empty()) return std::string(find(kMiddleBones, joint));
  if (const std::string_view bone = find(kSideBones, joint); !bone.empty()) return side + std::string(bone);
  const std::string finger = finger_bone(joint);
  return finger.empty() ? std::string() : side + finger;
}

Humanoid find_humanoid(const Avatar& avatar, std::span<const std::byte> glb) {
  gltf::Report report("avatar.glb");
  const json root = json::parse(gltf::split_glb(glb, report).json, nullptr, false);
  Humanoid humanoid = by_vrm(root, avatar.nodes.size());
  if (!humanoid.node_of.empty()) return humanoid;
  humanoid = {};
  for (std::size_t i = 0; i < avatar.nodes.size(); ++i) {
    std::string bone = humanoid_bone(avatar.nodes[i].name);
    if (!bone.empty()) humanoid.node_of.emplace(std::move(bone), i);
  }
  return humanoid;
}

}  // namespace vestige
