#pragma once

#include <string>

#include "traces/scene/avatar.hpp"

namespace vestige {

/// Returns an animation by its name or, if no animation has that name, by its index. "none" returns null. An empty text
/// returns the first animation, or null if there is none. Throws `UsageError` with a list of the animations.
const Animation* find_animation(const Avatar& avatar, const std::string& name_or_index);

/// Says that the animation moves the skin by morph targets, and how far. Precondition: `animation.morph`.
std::string describe_morph(const Animation& animation);

}  // namespace vestige
