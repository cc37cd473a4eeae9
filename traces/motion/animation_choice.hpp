#pragma once

#include <string>

#include "traces/scene/avatar.hpp"

namespace vestige {

/// An animation by its name or, if none has it, by its index; "none" is null. Empty: the first, if there is one. Throws
/// `UsageError` listing what there is.
const Animation* find_animation(const Avatar& avatar, const std::string& name_or_index);

}  // namespace vestige
