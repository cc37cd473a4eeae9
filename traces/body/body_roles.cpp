#include "traces/body/body_roles.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "traces/body/bone_names.hpp"

namespace vestige {

namespace {

bool is_upper(char c) {
  return c >= 'A' && c <= 'Z';
}
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}
bool is_letter(char c) {
  return is_upper(c) || (c >= 'a' && c <= 'z');
}
char lower(char c) {
  return is_upper(c) ? static_cast<char>(c - 'A' + 'a') : c;
}

std::string_view without_namespace(std::string_view name) {
  const std::size_t end = name.find_last_of(":|");
  return end == std::string_view::npos || end + 1 == name.size() ? name : name.substr(end + 1);
}

/// Splits a name into words: "mixamorig:LeftUpLeg" into left, up, leg; "LHipJoint" into l, hip, joint; "upperarm01.L"
/// into upperarm, 01, l.
std::vector<std::string> words_of(std::string_view name) {
  std::vector<std::string> words;
  char before = ' ';
  for (std::size_t i = 0; i < name.size(); ++i) {
    const char c = name[i];
    const bool is_word = is_letter(c) || is_digit(c);
    const bool next_is_small = i + 1 < name.size() && is_letter(name[i + 1]) && !is_upper(name[i + 1]);
    const bool begins = (!is_letter(before) && !is_digit(before)) || is_digit(before) != is_digit(c) ||
                        (is_upper(c) && (!is_upper(before) || next_is_small));
    if (is_word && (begins || words.empty())) words.emplace_back();
    if (is_word) words.back() += lower(c);
    before = is_word ? c : ' ';
  }
  return words;
}

/// A role judged by the name alone. A weak guess counts only if no other joint has the role.
struct Guess {
  BodyRole role;
  enum class Strength { kWeak, kStrong } strength = Strength::kStrong;
};

// Words that do not tell the bone (kNoise), and words that say that a joint is not a bone (kHelpers).
const std::set<std::string, std::less<>> kNoise = {"mixamorig", "bip",   "b",     "j",   "c",   "cc",        "base",
                                                   "bone",      "joint", "jnt",   "def", "f",   "rig",       "skeleton",
                                                   "armature",  "valve", "biped", "sk",  "bvh", "character", "jt"};
const std::set<std::string, std::less<>> kHelpers = {
    "ik",  "pole", "target", "control", "ctrl",     "socket", "slot",   "handslot", "twist",      "roll",
    "end", "nub",  "site",   "helper",  "effector", "adj",    "breast", "weapon",   "metacarpal", "tip"};

using Part = BodyPart;
using Strength = Guess::Strength;

const std::map<std::string, std::pair<Part, Strength>, std::less<>> kCentre = {
    {"hips", {Part::kHips, Strength::kStrong}},        {"hip", {Part::kHips, Strength::kStrong}},
    {"pelvis", {Part::kHips, Strength::kStrong}},      {"neck", {Part::kNeck, Strength::kStrong}},
    {"head", {Part::kHead, Strength::kStrong}},        {"jaw", {Part::kJaw, Strength::kStrong}},
    {"spine", {Part::kSpine, Strength::kStrong}},      {"chest", {Part::kSpine, Strength::kStrong}},
    {"upperchest", {Part::kSpine, Strength::kStrong}}, {"abdomen", {Part::kSpine, Strength::kStrong}},
    {"lowerback", {Part::kSpine, Strength::kStrong}},  {"thorax", {Part::kSpine, Strength::kStrong}},
    {"torso", {Part::kSpine, Strength::kStrong}},      {"waist", {Part::kSpine, Strength::kStrong}}};

// Skeletons that name the collar bone "collar" may name the upper arm "shoulder", so some guesses are weak.
const std::map<std::string, std::pair<Part, Strength>, std::less<>> kSided = {
    {"shoulder", {Part::kShoulder, Strength::kWeak}},
    {"clavicle", {Part::kShoulder, Strength::kStrong}},
    {"collar", {Part::kShoulder, Strength::kStrong}},
    {"collarbone", {Part::kShoulder, Strength::kStrong}},
    {"upperarm", {Part::kUpperArm, Strength::kStrong}},
    {"uparm", {Part::kUpperArm, Strength::kStrong}},
    {"arm", {Part::kUpperArm, Strength::kStrong}},
    {"shldr", {Part::kUpperArm, Strength::kStrong}},
    {"lowerarm", {Part::kLowerArm, Strength::kStrong}},
    {"loarm", {Part::kLowerArm, Strength::kStrong}},
    {"forearm", {Part::kLowerArm, Strength::kStrong}},
    {"elbow", {Part::kLowerArm, Strength::kStrong}},
    {"hand", {Part::kHand, Strength::kStrong}},
    {"wrist", {Part::kHand, Strength::kWeak}},
    {"upperleg", {Part::kUpperLeg, Strength::kStrong}},
    {"upleg", {Part::kUpperLeg, Strength::kStrong}},
    {"thigh", {Part::kUpperLeg, Strength::kStrong}},
    {"hip", {Part::kUpperLeg, Strength::kWeak}},
    {"lowerleg", {Part::kLowerLeg, Strength::kStrong}},
    {"loleg", {Part::kLowerLeg, Strength::kStrong}},
    {"leg", {Part::kLowerLeg, Strength::kStrong}},
    {"shin", {Part::kLowerLeg, Strength::kStrong}},
    {"calf", {Part::kLowerLeg, Strength::kStrong}},
    {"knee", {Part::kLowerLeg, Strength::kStrong}},
    {"foot", {Part::kFoot, Strength::kStrong}},
    {"ankle", {Part::kFoot, Strength::kStrong}},
    {"toe", {Part::kToes, Strength::kStrong}},
    {"toes", {Part::kToes, Strength::kStrong}},
    {"toebase", {Part::kToes, Strength::kStrong}},
    {"ball", {Part::kToes, Strength::kStrong}},
    {"eye", {Part::kEye, Strength::kStrong}}};

const std::map<std::string, Part, std::less<>> kFingers = {
    {"thumb", Part::kThumb}, {"index", Part::kIndex},   {"middle", Part::kMiddle}, {"mid", Part::kMiddle},
    {"ring", Part::kRing},   {"little", Part::kLittle}, {"pinky", Part::kLittle}};

/// The parts of a name.
struct NameParts {
  BodySide side = BodySide::kNone;
  std::string core;  ///< the remaining words, joined
  std::vector<std::string> words;
  std::vector<int> numbers;
  bool is_helper = false;
};

NameParts parts_of(std::string_view name) {
  NameParts parts;
  parts.is_helper = name.starts_with("__");  // MakeHuman's links, which do not move
  for (std::string word : words_of(without_namespace(name))) {
    if (is_digit(word.front())) {
      parts.numbers.push_back(word.size() < 6 ? std::stoi(word) : 0);
      continue;
    }
    for (const auto& [side, text] : {std::pair(BodySide::kLeft, std::string("left")), {BodySide::kRight, "right"}}) {
      if (word == text || word == text.substr(0, 1)) {
        parts.side = side;
        word.clear();
      } else if (word.starts_with(text)) {
        parts.side = side;
        word.erase(0, text.size());
      }
    }
    if (word.empty() || kNoise.contains(word)) continue;
    parts.is_helper = parts.is_helper || kHelpers.contains(word);
    parts.core += word;
    parts.words.push_back(std::move(word));
  }
  return parts;
}

std::optional<Guess> guess_finger(const NameParts& parts) {
  if (parts.side == BodySide::kNone) return {};
  int segment = parts.numbers.empty() ? 1 : parts.numbers.back();
  for (const std::string& word : parts.words) {
    if (word == "proximal") segment = 1;
    if (word == "intermediate") segment = 2;
    if (word == "distal") segment = 3;
  }
  for (const std::string& word : parts.words)
    if (const auto finger = kFingers.find(word); finger != kFingers.end())
      return Guess{{finger->second, parts.side, segment}, Strength::kStrong};
  constexpr std::array kCounted = {Part::kThumb, Part::kIndex, Part::kMiddle, Part::kRing, Part::kLittle};
  if (parts.core == "finger" && parts.numbers.size() == 2 && parts.numbers[0] >= 1 &&
      parts.numbers[0] <= std::ssize(kCounted))
    return Guess{{kCounted[static_cast<std::size_t>(parts.numbers[0]) - 1], parts.side, segment}, Strength::kStrong};
  return {};
}

std::optional<Guess> guess(const NameParts& parts) {
  if (parts.is_helper) return {};
  if (auto finger = guess_finger(parts)) return finger;
  if (parts.core.ends_with("spine")) return Guess{{Part::kSpine, BodySide::kNone, 0}, Strength::kStrong};
  const bool has_side = parts.side != BodySide::kNone;
  const auto& table = has_side ? kSided : kCentre;
  const auto known = table.find(parts.core);
  if (known == table.end()) return {};
  return Guess{{known->second.first, parts.side, 0}, known->second.second};
}

using Roles = std::vector<std::optional<BodyRole>>;

class RoleFinder {
 public:
  explicit RoleFinder(std::span<const NamedJoint> joints) : joints_(joints), roles_(joints.size()) {
    for (const NamedJoint& joint : joints) parts_.push_back(parts_of(joint.name));
  }

  Roles find() {
    for (const BodySide side : {BodySide::kLeft, BodySide::kRight}) {
      number_limb(side, "leg", {Part::kUpperLeg, Part::kLowerLeg, Part::kFoot, Part::kToes});
      number_limb(side, "arm", {Part::kUpperArm, Part::kLowerArm, Part::kHand});
    }
    take(Strength::kStrong);
    take(Strength::kWeak);
    name_upper_arms_called_shoulders();
    complete_hips();
    complete_head();
    number_spine();
    return std::move(roles_);
  }

 private:
  std::optional<std::size_t> joint_of(const BodyRole& role) const {
    const auto found = std::ranges::find(roles_, std::optional(role));
    if (found == roles_.end()) return {};
    return static_cast<std::size_t>(found - roles_.begin());
  }

  void give(std::size_t joint, const BodyRole& role) {
    if (!roles_[joint] && !joint_of(role)) roles_[joint] = role;
  }

  /// "leg_joint_R_1", "leg_joint_R_2", …: the bones of a limb from the body outwards.
  void number_limb(BodySide side, std::string_view core, const std::vector<BodyPart>& limb) {
    std::vector<std::size_t> chain;
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      if (parts_[i].side != side || parts_[i].core != core || parts_[i].is_helper) continue;
      if (chain.empty() || joints_[i].parent == static_cast<int>(chain.back())) chain.push_back(i);
    }
    if (chain.size() < 3) return;
    for (std::size_t k = 0; k < std::min(chain.size(), limb.size()); ++k) give(chain[k], {limb[k], side, 0});
  }

  void take(Strength strength) {
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      const auto guessed = guess(parts_[i]);
      if (guessed && guessed->strength == strength && guessed->role.part != Part::kSpine) give(i, guessed->role);
    }
  }

  void name_upper_arms_called_shoulders() {
    for (const BodySide side : {BodySide::kLeft, BodySide::kRight}) {
      if (joint_of({Part::kUpperArm, side, 0})) continue;
      for (std::size_t i = 0; i < joints_.size(); ++i) {
        if (parts_[i].side != side || parts_[i].core != "shoulder" || parts_[i].is_helper) continue;
        roles_[i] = BodyRole{Part::kUpperArm, side, 0};
        break;
      }
    }
  }

  /// Finds the hips: the joint from which both thighs hang.
  void complete_hips() {
    if (joint_of({Part::kHips, BodySide::kNone, 0})) return;
    const auto left = joint_of({Part::kUpperLeg, BodySide::kLeft, 0});
    const auto right = joint_of({Part::kUpperLeg, BodySide::kRight, 0});
    if (!left || !right) return;
    std::set<int> above;
    for (int i = joints_[*left].parent; i >= 0; i = joints_[static_cast<std::size_t>(i)].parent) above.insert(i);
    for (int i = joints_[*right].parent; i >= 0; i = joints_[static_cast<std::size_t>(i)].parent)
      if (above.contains(i)) return give(static_cast<std::size_t>(i), {Part::kHips, BodySide::kNone, 0});
  }

  /// Finds the head: the second of two necks.
  void complete_head() {
    if (joint_of({Part::kHead, BodySide::kNone, 0})) return;
    const auto neck = joint_of({Part::kNeck, BodySide::kNone, 0});
    for (std::size_t i = 0; neck && i < joints_.size(); ++i)
      if (joints_[i].parent == static_cast<int>(*neck) && parts_[i].core == "neck")
        give(i, {Part::kHead, BodySide::kNone, 0});
  }

  /// Numbers the spine from the neck (or head) down to the hips, or to the root if the hips hang beside the spine.
  void number_spine() {
    auto top = joint_of({Part::kNeck, BodySide::kNone, 0});
    if (!top) top = joint_of({Part::kHead, BodySide::kNone, 0});
    if (!top) return;
    std::vector<std::size_t> spine;
    for (int i = joints_[*top].parent; i >= 0; i = joints_[static_cast<std::size_t>(i)].parent) {
      const auto joint = static_cast<std::size_t>(i);
      if (roles_[joint]) break;
      const auto guessed = guess(parts_[joint]);
      if (guessed && guessed->role.part == Part::kSpine) spine.push_back(joint);
    }
    int segment = 0;
    for (auto joint = spine.rbegin(); joint != spine.rend(); ++joint)
      roles_[*joint] = BodyRole{Part::kSpine, BodySide::kNone, segment++};
  }

  std::span<const NamedJoint> joints_;
  std::vector<NameParts> parts_;
  Roles roles_;
};

/// Returns for each node the outermost joint at or above it, or -1.
std::vector<int> skeletons_of(const Avatar& avatar) {
  std::vector<bool> is_joint(avatar.nodes.size());
  for (const PaletteEntry& entry : avatar.palette) is_joint[static_cast<std::size_t>(entry.node)] = true;
  std::vector<int> skeletons(avatar.nodes.size(), -1);
  for (const int index : avatar.node_order) {
    const auto node = static_cast<std::size_t>(index);
    const int parent = avatar.nodes[node].parent;
    if (parent >= 0) skeletons[node] = skeletons[static_cast<std::size_t>(parent)];
    if (skeletons[node] < 0 && is_joint[node]) skeletons[node] = index;
  }
  return skeletons;
}

/// Returns the nodes of each skeleton, by its outermost joint.
std::vector<std::pair<std::size_t, std::vector<NamedJoint>>> joints_by_skeleton(const Avatar& avatar) {
  const std::vector<int> skeletons = skeletons_of(avatar);
  std::vector<std::pair<std::size_t, std::vector<NamedJoint>>> found;
  std::map<int, std::size_t> place_of;                 // in `found`, by outermost joint
  std::vector<int> place_in(avatar.nodes.size(), -1);  // in its skeleton, by node
  for (const int index : avatar.node_order) {
    const auto node = static_cast<std::size_t>(index);
    if (skeletons[node] < 0) continue;
    const auto [place, is_new] = place_of.emplace(skeletons[node], found.size());
    if (is_new) found.emplace_back(static_cast<std::size_t>(skeletons[node]), std::vector<NamedJoint>());
    std::vector<NamedJoint>& joints = found[place->second].second;
    place_in[node] = static_cast<int>(joints.size());
    const int parent = is_new ? -1 : place_in[static_cast<std::size_t>(avatar.nodes[node].parent)];
    joints.push_back({avatar.nodes[node].name, parent});
  }
  return found;
}

}  // namespace

std::vector<std::optional<BodyRole>> body_roles(std::span<const NamedJoint> joints) {
  return RoleFinder(joints).find();
}

std::vector<NamedJoint> named_joints(const Avatar& avatar) {
  std::vector<NamedJoint> joints;
  std::vector<int> place(avatar.nodes.size(), -1);
  for (const int index : avatar.node_order) {
    const Node& node = avatar.nodes[static_cast<std::size_t>(index)];
    place[static_cast<std::size_t>(index)] = static_cast<int>(joints.size());
    joints.push_back({node.name, node.parent < 0 ? -1 : place[static_cast<std::size_t>(node.parent)]});
  }
  return joints;
}

std::vector<std::size_t> bodies_of(const Avatar& avatar) {
  std::vector<std::size_t> bodies;
  for (const auto& [outermost, joints] : joints_by_skeleton(avatar)) {
    const Roles roles = body_roles(joints);
    const auto has = [&](BodyPart part) {
      return std::ranges::any_of(roles, [&](const auto& role) { return role && role->part == part; });
    };
    if (has(Part::kHips) && (has(Part::kUpperArm) || has(Part::kUpperLeg))) bodies.push_back(outermost);
  }
  return bodies;
}

std::vector<std::optional<BodyRole>> body_roles(const Avatar& avatar) {
  std::vector<NamedJoint> joints = named_joints(avatar);
  if (const auto bodies = bodies_of(avatar); bodies.size() > 1) {
    const std::vector<int> skeletons = skeletons_of(avatar);
    for (std::size_t i = 0; i < joints.size(); ++i)
      if (skeletons[static_cast<std::size_t>(avatar.node_order[i])] != static_cast<int>(bodies.front()))
        joints[i].name.clear();
  }
  const Roles ordered = body_roles(joints);
  Roles roles(avatar.nodes.size());
  for (std::size_t i = 0; i < ordered.size(); ++i) roles[static_cast<std::size_t>(avatar.node_order[i])] = ordered[i];
  if (avatar.humanoid.source == Humanoid::Source::kNames) return roles;
  for (const auto& [bone, node] : avatar.humanoid.node_of) {
    const auto role = role_of_bone(bone);
    if (!role) continue;
    std::ranges::replace(roles, role, std::nullopt);
    roles[node] = role;
  }
  return roles;
}

std::string plain_joint_name(std::string_view name) {
  std::string plain;
  for (const char c : without_namespace(name))
    if (is_letter(c) || is_digit(c)) plain += lower(c);
  return plain;
}

}  // namespace vestige
