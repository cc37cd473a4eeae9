#pragma once

#include "analysis/plot/data/growth_data.hpp"
#include "analysis/plot/data/sweep_data.hpp"

namespace vestige::plot {

/// Returns whether `vestige sweep --avatars` measured these: several numbers of people.
bool has_crowds(const Sweeps& sweeps);

/// Returns the cost against the number of people, a panel for each number of colliders. Precondition: `has_crowds`.
/// Throws `Error` if there are several files.
GrowthResult crowd_growth(const Sweeps& sweeps);

}  // namespace vestige::plot
