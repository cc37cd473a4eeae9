#pragma once

#include "traces/scene/avatar.hpp"

namespace vestige {

/// Returns the same avatar with four times the triangles. Every edge is halved, and triangle i becomes 4 i … 4 i + 3:
/// three at its corners and one in the middle. A new vertex has the mean position, texture coordinates and weights of
/// its edge's ends. If there are more than `kMaxInfluences` weights, the heaviest are kept. Coincident vertices at a
/// seam stay coincident, so a closed surface stays closed. Throws `Error` if vertices or triangles would not fit into
/// 32 bits.
Avatar subdivided(const Avatar& avatar);

}  // namespace vestige
