#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "traces/avatar.hpp"

namespace vestige {

/// What an avatar's skin is divided into. Left and right follow from where it is.
enum class BodyPart { kTorso, kNeck, kHead, kUpperArm, kForearm, kHand, kThigh, kShin, kFoot };
inline constexpr std::size_t kBodyParts = 9;

/// "torso", "neck", "head", "upper arm", …
std::string_view to_string(BodyPart part);
std::optional<BodyPart> body_part_named(std::string_view name);

/// The part that each node's skin belongs to, by the words in its name that rigs have in common (Mixamo, VRM, Biped,
/// MakeHuman, Blender's and others: "LeftForeArm", "J_Bip_L_LowerArm", "lowerarm01.L"), else its parent's. Of limbs
/// whose joints are only numbered ("arm_joint_L_1", "…_2") the first is the upper part, the next the lower one, then
/// hand or foot. None for nodes with no such word above them.
std::vector<std::optional<BodyPart>> parts_of_nodes(const Avatar& avatar);

}  // namespace vestige
