#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "traces/scene/avatar.hpp"

namespace vestige {

/// The parts of an avatar's skin. Left and right follow from the position.
enum class SkinPart { kTorso, kNeck, kHead, kUpperArm, kForearm, kHand, kThigh, kShin, kFoot };
inline constexpr std::size_t kSkinParts = 9;

/// "torso", "neck", "head", "upper arm", …
std::string_view to_string(SkinPart part);
std::optional<SkinPart> skin_part_named(std::string_view name);

/// Returns the part that each node's skin belongs to. The node's role in the body decides
/// (traces/body/body_roles.hpp). A node without a role takes its parent's part. A node without a role above it has no
/// part.
std::vector<std::optional<SkinPart>> parts_of_nodes(const Avatar& avatar);

}  // namespace vestige
