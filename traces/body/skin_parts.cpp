#include "traces/body/skin_parts.hpp"

#include <algorithm>
#include <array>

#include "traces/body/body_roles.hpp"

namespace vestige {

namespace {

constexpr std::array<std::string_view, kSkinParts> kPartNames = {"torso", "neck",  "head", "upper arm", "forearm",
                                                                 "hand",  "thigh", "shin", "foot"};

SkinPart skin_of(BodyPart part) {
  switch (part) {
    case BodyPart::kHips:
    case BodyPart::kSpine:
    case BodyPart::kShoulder:
      return SkinPart::kTorso;
    case BodyPart::kNeck:
      return SkinPart::kNeck;
    case BodyPart::kHead:
    case BodyPart::kJaw:
    case BodyPart::kEye:
      return SkinPart::kHead;
    case BodyPart::kUpperArm:
      return SkinPart::kUpperArm;
    case BodyPart::kLowerArm:
      return SkinPart::kForearm;
    case BodyPart::kHand:
    case BodyPart::kThumb:
    case BodyPart::kIndex:
    case BodyPart::kMiddle:
    case BodyPart::kRing:
    case BodyPart::kLittle:
      return SkinPart::kHand;
    case BodyPart::kUpperLeg:
      return SkinPart::kThigh;
    case BodyPart::kLowerLeg:
      return SkinPart::kShin;
    case BodyPart::kFoot:
    case BodyPart::kToes:
      return SkinPart::kFoot;
  }
  return SkinPart::kTorso;
}

}  // namespace

std::string_view to_string(SkinPart part) {
  return kPartNames[static_cast<std::size_t>(part)];
}

std::optional<SkinPart> skin_part_named(std::string_view name) {
  const auto* found = std::ranges::find(kPartNames, name);
  if (found == kPartNames.end()) return std::nullopt;
  return static_cast<SkinPart>(found - kPartNames.begin());
}

std::vector<std::optional<SkinPart>> parts_of_nodes(const Avatar& avatar) {
  const auto roles = body_roles(avatar);
  std::vector<std::optional<SkinPart>> parts(avatar.nodes.size());
  for (const int number : avatar.node_order) {
    const auto i = static_cast<std::size_t>(number);
    const int parent = avatar.nodes[i].parent;
    if (roles[i])
      parts[i] = skin_of(roles[i]->part);
    else if (parent >= 0)
      parts[i] = parts[static_cast<std::size_t>(parent)];
  }
  return parts;
}

}  // namespace vestige
