#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "traces/scene/avatar.hpp"

namespace vestige {

/// What an avatar's skin is divided into. Left and right follow from where it is.
enum class SkinPart { kTorso, kNeck, kHead, kUpperArm, kForearm, kHand, kThigh, kShin, kFoot };
inline constexpr std::size_t kSkinParts = 9;

/// "torso", "neck", "head", "upper arm", …
std::string_view to_string(SkinPart part);
std::optional<SkinPart> skin_part_named(std::string_view name);

/// The part that each node's skin belongs to, by its role in the body (traces/motion/body_roles.hpp), else its
/// parent's. None for nodes without a role above them.
std::vector<std::optional<SkinPart>> parts_of_nodes(const Avatar& avatar);

}  // namespace vestige
