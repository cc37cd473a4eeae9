#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include "traces/scene/avatar.hpp"
#include "traces/scene/colliders.hpp"

namespace vestige {

struct ScenarioSettings {
  std::uint32_t count = 100;
  std::uint64_t seed = 1;
  std::optional<float> radius_m = {};  ///< of every collider, for scenarios of spheres; empty: the scenario's own
};

/// A built-in scenario. Its colliders are points, or in some scenarios spheres. The same avatar, animation, count and
/// seed give the same positions at the same times, at any sampling rate. Another seed gives others. 100 colliders stay
/// within 3 m of the avatar.
struct Scenario {
  std::string_view name;
  std::string_view summary;  ///< at most 63 characters: one line of help, behind the name
  std::uint32_t default_count;
  /// `animation` may be null, for an avatar at rest.
  std::unique_ptr<ColliderSource> (*make)(const Avatar& avatar, const Animation* animation,
                                          const ScenarioSettings& settings);
};

/// Returns all scenarios in the order of listing.
std::span<const Scenario> scenarios();

/// Returns null if no scenario has this name.
const Scenario* find_scenario(std::string_view name);

}  // namespace vestige
