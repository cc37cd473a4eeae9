#pragma once

#include <optional>

#include "detector/decision.hpp"

namespace vestige {

/// `decide_sphere` in integers of any size. The answer is correct for all finite doubles, and the number of steps does
/// not depend on them. It follows the table in detector/CONTRACT.md, Spheres: the first root, over the face, the edges
/// and the corners, at which the nearest point lies in that part.
std::optional<FirstTouch> sphere_in_integers(const MovingSphere& sphere, const Corners& before, const Corners& after);

}  // namespace vestige
