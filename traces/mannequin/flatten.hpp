#pragma once

#include <glm/vec2.hpp>
#include <vector>

#include "traces/mannequin/charts.hpp"

namespace vestige::mannequin {

/// Lays one chart flat: metres, anywhere, in the order of its vertices. From a barycentric map onto a disk (Tutte 1963:
/// no triangle is turned over) by local and global steps (Liu et al. 2008, section 4.1).
std::vector<glm::dvec2> flatten(const Surface& surface, const Chart& chart);

}  // namespace vestige::mannequin
