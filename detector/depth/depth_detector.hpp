#pragma once

#include <memory>

#include "detector/detector.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige {

/// Returns a detector whose contacts also carry `Plane::kDepth`. It finds them by `detector`, and their depth on the
/// whole skin of `avatar`, of which it keeps a reference.
std::unique_ptr<Detector> with_depth(std::unique_ptr<Detector> detector, const Avatar& avatar);

}  // namespace vestige
