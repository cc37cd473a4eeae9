#include "analysis/mapping/joint_names.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <string>

#include "traces/pose.hpp"

namespace vestige {

namespace {

constexpr std::array<std::string_view, kBodyParts> kPartNames = {"torso", "neck",  "head", "upper arm", "forearm",
                                                                 "hand",  "thigh", "shin", "foot"};

/// What a joint's name says; of some only that they belong to a limb.
enum class Word { kPart, kArm, kLeg, kHip };

struct Key {
  std::string_view letters;
  Word word;
  BodyPart part = BodyPart::kTorso;
};

/// The first that a name contains decides, so that longer words stand before those within them.
constexpr std::array kKeys = {Key{"head", Word::kPart, BodyPart::kHead},
                              Key{"skull", Word::kPart, BodyPart::kHead},
                              Key{"neck", Word::kPart, BodyPart::kNeck},
                              Key{"hand", Word::kPart, BodyPart::kHand},
                              Key{"wrist", Word::kPart, BodyPart::kHand},
                              Key{"forearm", Word::kPart, BodyPart::kForearm},
                              Key{"lowerarm", Word::kPart, BodyPart::kForearm},
                              Key{"armlower", Word::kPart, BodyPart::kForearm},
                              Key{"elbow", Word::kPart, BodyPart::kForearm},
                              Key{"upperarm", Word::kPart, BodyPart::kUpperArm},
                              Key{"armupper", Word::kPart, BodyPart::kUpperArm},
                              Key{"foot", Word::kPart, BodyPart::kFoot},
                              Key{"ankle", Word::kPart, BodyPart::kFoot},
                              Key{"toe", Word::kPart, BodyPart::kFoot},
                              Key{"heel", Word::kPart, BodyPart::kFoot},
                              Key{"thigh", Word::kPart, BodyPart::kThigh},
                              Key{"upleg", Word::kPart, BodyPart::kThigh},
                              Key{"upperleg", Word::kPart, BodyPart::kThigh},
                              Key{"legupper", Word::kPart, BodyPart::kThigh},
                              Key{"shin", Word::kPart, BodyPart::kShin},
                              Key{"calf", Word::kPart, BodyPart::kShin},
                              Key{"lowerleg", Word::kPart, BodyPart::kShin},
                              Key{"leglower", Word::kPart, BodyPart::kShin},
                              Key{"knee", Word::kPart, BodyPart::kShin},
                              Key{"shoulder", Word::kPart, BodyPart::kTorso},
                              Key{"clavicle", Word::kPart, BodyPart::kTorso},
                              Key{"collar", Word::kPart, BodyPart::kTorso},
                              Key{"spine", Word::kPart, BodyPart::kTorso},
                              Key{"chest", Word::kPart, BodyPart::kTorso},
                              Key{"torso", Word::kPart, BodyPart::kTorso},
                              Key{"body", Word::kPart, BodyPart::kTorso},
                              Key{"pelvis", Word::kPart, BodyPart::kTorso},
                              Key{"waist", Word::kPart, BodyPart::kTorso},
                              Key{"abdomen", Word::kPart, BodyPart::kTorso},
                              Key{"belly", Word::kPart, BodyPart::kTorso},
                              Key{"breast", Word::kPart, BodyPart::kTorso},
                              Key{"hip", Word::kHip},
                              Key{"arm", Word::kArm},
                              Key{"leg", Word::kLeg}};

/// Small letters alone, without the name that Blender gives to skeletons, which has an "arm" in it.
std::string letters_of(std::string_view name) {
  std::string letters;
  for (const char c : name)
    if (std::isalpha(static_cast<unsigned char>(c)) != 0)
      letters.push_back(static_cast<char>(std::tolower(static_cast<unsigned char>(c))));
  constexpr std::string_view kArmature = "armature";
  if (const auto at = letters.find(kArmature); at != std::string::npos) letters.erase(at, kArmature.size());
  return letters;
}

const Key* key_of(std::string_view name) {
  const std::string letters = letters_of(name);
  const auto* found =
      std::ranges::find_if(kKeys, [&](const Key& key) { return letters.find(key.letters) != std::string::npos; });
  return found == kKeys.end() ? nullptr : found;
}

/// The next one down a limb of three parts, the first of which is `upper`.
BodyPart next_down(BodyPart upper, std::optional<BodyPart> parent) {
  const auto first = static_cast<int>(upper);
  const int above = parent ? static_cast<int>(*parent) : -1;
  if (above < first || above > first + 2) return upper;
  return static_cast<BodyPart>(std::min(above + 1, first + 2));
}

}  // namespace

std::string_view to_string(BodyPart part) {
  return kPartNames[static_cast<std::size_t>(part)];
}

std::optional<BodyPart> body_part_named(std::string_view name) {
  const auto* found = std::ranges::find(kPartNames, name);
  if (found == kPartNames.end()) return std::nullopt;
  return static_cast<BodyPart>(found - kPartNames.begin());
}

std::vector<std::optional<BodyPart>> parts_of_nodes(const Avatar& avatar) {
  std::vector<glm::dmat4> world;
  world_matrices(avatar, rest_pose(avatar), world);
  double low_y = 0;
  double high_y = 0;
  double sum_x = 0;
  for (const PaletteEntry& entry : avatar.palette) {
    const glm::dvec4& at = world[static_cast<std::size_t>(entry.node)][3];
    low_y = std::min(low_y, at.y);
    high_y = std::max(high_y, at.y);
    sum_x += at.x;
  }
  const double middle_x = avatar.palette.empty() ? 0 : sum_x / static_cast<double>(avatar.palette.size());
  // Some rigs call the pelvis "hip", some the joint of a thigh.
  const auto is_beside_middle = [&](std::size_t node) {
    return std::abs(world[node][3].x - middle_x) > 0.02 * (high_y - low_y);
  };
  std::vector<std::optional<BodyPart>> parts(avatar.nodes.size());
  bool has_head = false;
  for (const int number : avatar.node_order) {
    const auto i = static_cast<std::size_t>(number);
    const Node& node = avatar.nodes[i];
    const std::optional<BodyPart> above = node.parent < 0 ? std::nullopt : parts[static_cast<std::size_t>(node.parent)];
    const Key* key = key_of(node.name);
    if (key == nullptr) {
      parts[i] = above;
    } else if (key->word == Word::kArm) {
      parts[i] = next_down(BodyPart::kUpperArm, above);
    } else if (key->word == Word::kLeg) {
      parts[i] = next_down(BodyPart::kThigh, above);
    } else if (key->word == Word::kHip) {
      parts[i] = is_beside_middle(i) ? BodyPart::kThigh : BodyPart::kTorso;
    } else {
      parts[i] = key->part;
    }
    has_head = has_head || parts[i] == BodyPart::kHead;
  }
  // Without a head, a second neck is one.
  if (!has_head)
    for (const int number : avatar.node_order) {
      const auto i = static_cast<std::size_t>(number);
      const int parent = avatar.nodes[i].parent;
      if (parent < 0 || parts[i] != BodyPart::kNeck) continue;
      const auto above = parts[static_cast<std::size_t>(parent)];
      if (above == BodyPart::kNeck || above == BodyPart::kHead) parts[i] = BodyPart::kHead;
    }
  return parts;
}

}  // namespace vestige
