#pragma once

#include <optional>

#include "analysis/accuracy/moving_scene.hpp"
#include "analysis/accuracy/true_contacts.hpp"

namespace vestige {

/// Returns the time in seconds, summed over the colliders, in which spheres are wholly inside the body and so touch
/// nothing: the winding number around their centres is not 0, and no true touch is under way. Looks at 60 frames a
/// second. Empty if the skin is not closed, since it has no inside then.
std::optional<double> inside_s(const MovingScene& scene, const TrueContacts& truth);

}  // namespace vestige
