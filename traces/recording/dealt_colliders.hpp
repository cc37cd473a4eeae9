#pragma once

#include <memory>
#include <vector>

#include "traces/scene/colliders.hpp"
#include "traces/scene/stance.hpp"

namespace vestige {

/// Colliders made around one person, and where that person stands.
struct Hand {
  std::unique_ptr<ColliderSource> colliders;
  Stance stance;
};

/// Returns the colliders of all hands together, each around its person. Ids are dealt in turn: with two hands, the
/// colliders 0, 1, 2, … of the first become 0, 2, 4, …, and those of the second 1, 3, 5, ….
std::unique_ptr<ColliderSource> deal_colliders(std::vector<Hand> hands);

/// Returns a source that never has a collider.
std::unique_ptr<ColliderSource> no_colliders();

}  // namespace vestige
