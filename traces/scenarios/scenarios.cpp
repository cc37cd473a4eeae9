#include "traces/scenarios/scenarios.hpp"

#include "traces/scenarios/makers.hpp"
#include "traces/scene/colliders.hpp"

namespace vestige {

std::span<const Scenario> scenarios() {
  static constexpr Scenario kScenarios[] = {
      {"swarm", "points that pierce the body from all sides while it moves", 100, make_swarm},
      {"rain", "drops that fall through the body from above", 100, make_rain},
      {"orbit", "points on level circles around the body, through its skin", 100, make_orbit},
      {"punch", "fists that strike torso and head from the front, 4 cm deep", 100, make_punch},
      {"slide", "one object that slides over the chest, dipping 4 mm into it", 1, make_slide},
      {"hug", "points that wander in and out, always within 2 cm of the skin", 100, make_hug},
      {"still", "points at rest that the moving body runs into", 100, make_still},
      {"rest", "hands of 5 cm laid on the skin, the first on a shoulder", 1, make_rest},
      {"brush", "a hand of 5 cm that strokes an arm from shoulder to wrist", 1, make_brush},
  };
  return kScenarios;
}

const Scenario* find_scenario(std::string_view name) {
  for (const Scenario& scenario : scenarios())
    if (scenario.name == name) return &scenario;
  return nullptr;
}

}  // namespace vestige
