#pragma once

#include "detector/decision.hpp"

namespace vestige {

/// `decide_static` in whole numbers, for what its filter cannot tell: touching, coplanar, degenerate, huge and tiny
/// things.
Decision decide_static_exactly(const Way& way, const Corners& triangle);

}  // namespace vestige
