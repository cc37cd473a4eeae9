#pragma once

#include <glm/vec2.hpp>
#include <vector>

#include "traces/mannequin/charts.hpp"

namespace vestige::mannequin {

/// Flattens one chart. Returns the positions of its vertices in order, in metres, at any place. Starts from a
/// barycentric map onto a disk (Tutte 1963: no triangle is flipped), then alternates local and global steps (Liu et al.
/// 2008, section 4.1).
std::vector<glm::dvec2> flatten(const Surface& surface, const Chart& chart);

}  // namespace vestige::mannequin
