#pragma once

#include <optional>

#include "detector/decision.hpp"

namespace vestige {

/// `decide_ccd` in integers of any size. The answer is correct for all finite doubles, and the number of steps does not
/// depend on them.
///
/// Let A, B, C be the corners relative to the point, each linear in t. The point is in the triangle's plane if f = -A .
/// (B x C), a cubic, is zero. Then A x B, B x C and C x A are parallel. The point is in the triangle if, coordinate by
/// coordinate, they do not have opposite signs. If all three vanish, the point and the corners are on one line. Then
/// the point is between two corners if one of A . B, B . C, C . A is not positive.
std::optional<FirstContact> ccd_in_integers(const Way& way, const Corners& before, const Corners& after);

}  // namespace vestige
