#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "analysis/frequency/sweep_sample.hpp"

namespace vestige {

/// How many people are measured at once: copies of all who are in the trace, in a row along +X, too far apart to touch
/// what flies around another.
struct Crowd {
  std::uint32_t copies = 1;
  bool first_only = false;  ///< whether only the first copy has the colliders of the trace around it, or each has
};

/// The ids of drawn colliders, ascending.
using DrawnIds = std::vector<std::uint32_t>;

/// What is measured: places of a trace, and the colliders drawn for each.
struct SweepScene {
  std::vector<Place> places;
  std::vector<std::vector<DrawnIds>> drawn;  ///< by count, then place
  std::vector<DrawnIds> drawn_for_any;       ///< by place: those drawn for any count
};

/// Draws, from all colliders of the trace, those for each count (`draw_colliders`). The places lose the colliders that
/// are drawn for no count: looking them up in every frame would cost time.
SweepScene make_sweep_scene(std::vector<Place> places, std::span<const std::uint32_t> ids,
                            const std::vector<std::uint32_t>& counts, std::uint64_t seed);

/// Returns the scene with copies of its people and, unless only the first has them, of its colliders, with other ids.
/// `ids` are those of all colliders of the trace, ascending. Of one copy, the scene is the same.
SweepScene with_copies(const SweepScene& scene, std::span<const std::uint32_t> ids, Crowd crowd);

}  // namespace vestige
