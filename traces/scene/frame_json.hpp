#pragma once

#include <string>
#include <vector>

#include "traces/scene/trace.hpp"

namespace vestige {

// The parts of a frame as JSON. traces/base/number_text.hpp describes the number format.

/// `{"origin": [x, y, z], "nodes": [[tx, ty, tz, rx, ry, rz, rw, sx, sy, sz], …]}`
void append_json(std::string& out, const Pose& pose);

/// `[{"id", "position": [x, y, z], "radius", "owner"}, …]`; a point has no radius, and what belongs to nobody no owner.
void append_json(std::string& out, const std::vector<ColliderSample>& colliders);

}  // namespace vestige
