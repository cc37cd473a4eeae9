#pragma once

#include <optional>

#include "detector/decision.hpp"

namespace vestige {

/// `decide_ccd` in whole numbers without bounds: right for all finite doubles, in a number of steps that does not
/// depend on them.
///
/// With A, B, C the corners as seen from the point, each linear in t, the point is in the triangle's plane when
/// f = -A . (B x C), a cubic, is zero. Then A x B, B x C and C x A are parallel, and the point is in the triangle when,
/// coordinate by coordinate, they do not have opposite signs; where all of them vanish, all is on one line through the
/// point, which is between two corners when one of A . B, B . C, C . A is not positive.
std::optional<FirstContact> ccd_in_integers(const Way& way, const Corners& before, const Corners& after);

}  // namespace vestige
