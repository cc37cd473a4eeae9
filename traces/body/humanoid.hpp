#pragma once

#include <string_view>

#include "traces/scene/avatar.hpp"
#include "traces/scene/humanoid.hpp"

namespace vestige {

/// Finds the bones by the table of VRMC_vrm, or if that gives none, of VRM. Finds those that the table does not have by
/// the nodes' names (body_roles.hpp). May find none. `extensions` is the JSON of the file's extensions. Never fails:
/// JSON that cannot be parsed has no extension.
Humanoid find_humanoid(const Avatar& avatar, std::string_view extensions);

}  // namespace vestige
