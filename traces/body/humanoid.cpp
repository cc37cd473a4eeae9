#include "traces/body/humanoid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "traces/body/body_roles.hpp"
#include "traces/body/bone_names.hpp"

namespace vestige {

namespace {

using nlohmann::json;

/// Converts VRM's bone name ("leftUpperArm") to Unity's. VRM 1.0 alone names the thumb's bones differently.
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

const json* member(const json* object, const char* name) {
  if (object == nullptr || !object->is_object()) return nullptr;
  const auto found = object->find(name);
  return found == object->end() ? nullptr : &*found;
}

void note(Humanoid& humanoid, std::string problem) {
  constexpr std::size_t kMostTold = 10;
  ++humanoid.problem_count;
  if (humanoid.problems.size() < kMostTold) humanoid.problems.push_back(std::move(problem));
}

/// Adds a bone. `field` is the bone's JSON path in the extension.
void take_bone(Humanoid& humanoid, std::string name, const json& bone, const Avatar& avatar, const std::string& field) {
  if (!role_of_bone(name)) {
    note(humanoid, fmt::format("{}: there is no bone {}: it is left out", field, name));
    return;
  }
  const json* node = member(&bone, "node");
  if (node == nullptr || !node->is_number_unsigned() || node->get<std::size_t>() >= avatar.nodes.size()) {
    note(humanoid, fmt::format("{}.node is not a node of the file: the bone {} is left out", field, name));
    return;
  }
  const auto index = node->get<std::size_t>();
  const auto same = std::ranges::find_if(humanoid.node_of, [&](const auto& known) { return known.second == index; });
  if (same != humanoid.node_of.end()) {
    note(humanoid,
         fmt::format("{}.node is {}, which is already the bone {}: {} is left out", field, index, same->first, name));
    return;
  }
  humanoid.node_of.emplace(std::move(name), index);
}

/// Adds the bones of VRM 1.0's table.
void take_vrm1(Humanoid& humanoid, const json& extension, const Avatar& avatar) {
  const std::string field = "extensions.VRMC_vrm.humanoid.humanBones";
  const json* bones = member(member(&extension, "humanoid"), "humanBones");
  if (bones == nullptr) return;
  if (!bones->is_object()) return note(humanoid, field + " is not an object: it names no bones");
  for (const auto& [name, bone] : bones->items())
    take_bone(humanoid, unity_name(name), bone, avatar, fmt::format("{}.{}", field, name));
}

/// Adds the bones of VRM 0.x's table.
void take_vrm0(Humanoid& humanoid, const json& extension, const Avatar& avatar) {
  const std::string field = "extensions.VRM.humanoid.humanBones";
  const json* bones = member(member(&extension, "humanoid"), "humanBones");
  if (bones == nullptr) return;
  if (!bones->is_array()) return note(humanoid, field + " is not an array: it names no bones");
  for (std::size_t i = 0; i < bones->size(); ++i) {
    const json& bone = (*bones)[i];
    const json* name = member(&bone, "bone");
    if (name == nullptr || !name->is_string()) {
      note(humanoid, fmt::format("{}[{}].bone is not a text", field, i));
      continue;
    }
    std::string unity = name->get<std::string>();
    if (!unity.empty()) unity[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(unity[0])));
    take_bone(humanoid, std::move(unity), bone, avatar, fmt::format("{}[{}]", field, i));
  }
}

Humanoid by_vrm(const json& extensions, const Avatar& avatar) {
  Humanoid humanoid;
  if (const json* vrm1 = member(&extensions, "VRMC_vrm")) {
    humanoid.source = Humanoid::Source::kVrm1;
    take_vrm1(humanoid, *vrm1, avatar);
  }
  const json* vrm0 = member(&extensions, "VRM");
  if (vrm0 == nullptr || !humanoid.node_of.empty()) return humanoid;
  take_vrm0(humanoid, *vrm0, avatar);
  // If neither table gives a bone, the newer one stands.
  if (!humanoid.node_of.empty() || humanoid.source == Humanoid::Source::kNames)
    humanoid.source = Humanoid::Source::kVrm0;
  return humanoid;
}

}  // namespace

Humanoid find_humanoid(const Avatar& avatar, std::string_view extensions) {
  Humanoid humanoid;
  // Other extensions may be long, and a tree of them even longer.
  if (extensions.find("\"VRM") != std::string_view::npos)
    humanoid = by_vrm(json::parse(extensions, nullptr, false), avatar);
  if (const auto bodies = humanoid.node_of.empty() ? bodies_of(avatar) : std::vector<std::size_t>(); bodies.size() > 1)
    note(humanoid,
         fmt::format("has {} skeletons of bodies, the first below nodes[{}] '{}' and another below nodes[{}] "
                     "'{}': the first one's bones tell its parts, its facing, and what follows a motion",
                     bodies.size(), bodies[0], avatar.nodes[bodies[0]].name, bodies[1], avatar.nodes[bodies[1]].name));
  std::set<std::size_t> taken;
  for (const auto& [bone, node] : humanoid.node_of) taken.insert(node);
  const auto roles = body_roles(avatar);
  for (std::size_t i = 0; i < roles.size(); ++i) {
    std::string bone = roles[i] ? bone_name(*roles[i]) : "";
    if (!bone.empty() && !taken.contains(i)) humanoid.node_of.emplace(std::move(bone), i);
  }
  return humanoid;
}

}  // namespace vestige
