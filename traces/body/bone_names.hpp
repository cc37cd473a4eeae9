#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "traces/body/body_roles.hpp"

namespace vestige {

/// Returns the name of a bone among Unity's HumanBodyBones, or an empty text if Unity has no such bone.
std::string bone_name(const BodyRole& role);

/// Returns the role of the bone with this name, or nothing if there is no such name.
std::optional<BodyRole> role_of_bone(std::string_view name);

}  // namespace vestige
