#include "traces/body/bone_names.hpp"

#include <array>
#include <map>

namespace vestige {

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
  const bool is_central = role.part <= BodyPart::kJaw;
  if (is_central != (role.side == BodySide::kNone)) return "";
  const auto segment = static_cast<std::size_t>(role.segment);
  if (role.part == BodyPart::kSpine) return segment < kSpine.size() ? kSpine[segment] : "";
  std::string name = role.side == BodySide::kLeft ? "Left" : role.side == BodySide::kRight ? "Right" : "";
  name += names.at(role.part);
  if (role.part < BodyPart::kThumb || role.part > BodyPart::kLittle) return name;
  return segment >= 1 && segment <= kPhalanges.size() ? name + kPhalanges[segment - 1] : "";
}

std::optional<BodyRole> role_of_bone(std::string_view name) {
  static const std::map<std::string, BodyRole, std::less<>> roles = [] {
    constexpr int kSegments = 4;
    std::map<std::string, BodyRole, std::less<>> all;
    for (int part = 0; part <= static_cast<int>(BodyPart::kToes); ++part)
      for (const BodySide side : {BodySide::kNone, BodySide::kLeft, BodySide::kRight})
        for (int segment = 0; segment < kSegments; ++segment) {
          const BodyRole role = {static_cast<BodyPart>(part), side, segment};
          if (std::string bone = bone_name(role); !bone.empty()) all.emplace(std::move(bone), role);
        }
    return all;
  }();
  const auto found = roles.find(name);
  return found == roles.end() ? std::nullopt : std::optional(found->second);
}

}  // namespace vestige
