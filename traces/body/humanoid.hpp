#pragma once

#include <string_view>

#include "traces/scene/avatar.hpp"
#include "traces/scene/humanoid.hpp"

namespace vestige {

/// Finds the bones by the table of the extension VRM or VRMC_vrm in `json`, the JSON of the avatar's file, and those
/// that it does not have by the nodes' names (body_roles.hpp). May find none. Never fails: JSON that cannot be parsed
/// has no extension.
Humanoid find_humanoid(const Avatar& avatar, std::string_view json);

}  // namespace vestige
