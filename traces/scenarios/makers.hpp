#pragma once

#include <memory>

#include "traces/scenarios/scenarios.hpp"
#include "traces/scene/colliders.hpp"

namespace vestige {

/// The makers in the table of scenarios; each source file describes its scenario. Lengths and speeds are those beside a
/// human being (`MovingBody::metre`), and positions lie on a grid of 2^-20 m. A source keeps references to the avatar
/// and the animation.
std::unique_ptr<ColliderSource> make_swarm(const Avatar& avatar, const Animation* animation,
                                           const ScenarioSettings& settings);
std::unique_ptr<ColliderSource> make_rain(const Avatar& avatar, const Animation* animation,
                                          const ScenarioSettings& settings);
std::unique_ptr<ColliderSource> make_orbit(const Avatar& avatar, const Animation* animation,
                                           const ScenarioSettings& settings);
std::unique_ptr<ColliderSource> make_punch(const Avatar& avatar, const Animation* animation,
                                           const ScenarioSettings& settings);
std::unique_ptr<ColliderSource> make_slide(const Avatar& avatar, const Animation* animation,
                                           const ScenarioSettings& settings);
std::unique_ptr<ColliderSource> make_hug(const Avatar& avatar, const Animation* animation,
                                         const ScenarioSettings& settings);
std::unique_ptr<ColliderSource> make_still(const Avatar& avatar, const Animation* animation,
                                           const ScenarioSettings& settings);
std::unique_ptr<ColliderSource> make_rest(const Avatar& avatar, const Animation* animation,
                                          const ScenarioSettings& settings);
std::unique_ptr<ColliderSource> make_brush(const Avatar& avatar, const Animation* animation,
                                           const ScenarioSettings& settings);

}  // namespace vestige
