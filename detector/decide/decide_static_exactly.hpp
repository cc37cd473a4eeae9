#pragma once

#include "detector/decision.hpp"

namespace vestige {

/// `decide_static` in integers, for the cases that its filter cannot decide: touching, coplanar, degenerate, huge and
/// tiny input.
Decision decide_static_exactly(const Way& way, const Corners& triangle);

}  // namespace vestige
