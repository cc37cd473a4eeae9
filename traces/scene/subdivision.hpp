#pragma once

#include "traces/scene/avatar.hpp"

namespace vestige {

/// The same avatar with four times the triangles: every edge is halved, and triangle i becomes 4 i … 4 i + 3, three at
/// its corners and the one between. A new vertex has the mean position, texture coordinates and weights of its edge's
/// ends; of more than `kMaxInfluences` the heaviest are kept. Vertices of a seam that lay on one another do so
/// afterwards: a closed surface stays closed. Throws `Error` where vertices or triangles would not fit into 32 bits.
Avatar subdivided(const Avatar& avatar);

}  // namespace vestige
