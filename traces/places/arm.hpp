#pragma once

#include <vector>

#include "traces/places/skin.hpp"

namespace vestige {

enum class ArmSide { kLeft, kRight };

/// Returns points on the outer side of an arm at rest, from the shoulder to the wrist, some 5 mm apart on a human
/// being. Empty if the avatar's bones do not name the arm.
std::vector<SkinPoint> outer_arm(const Skin& skin, ArmSide side);

/// Returns the place at `share` of the way along such points, from 0 to 1. Neighbouring places blend into each other.
SkinPlace place_along(const Skin& skin, const std::vector<SkinPoint>& points, double share,
                      const std::vector<glm::dmat4>& palette);

}  // namespace vestige
