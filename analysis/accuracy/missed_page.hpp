#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/accuracy/accuracy.hpp"
#include "analysis/accuracy/moving_scene.hpp"
#include "analysis/run/detector_team.hpp"
#include "detector/actuator_map.hpp"

namespace vestige {

/// A place of a measurement.
struct MostMissed {
  const AccuracyScene* scene = nullptr;
  const AccuracyPoint* point = nullptr;
};

/// Returns the point that misses the largest share of its true events within the tolerance, of equal ones that which
/// misses more by the rule of one test frame. Returns nothing if nothing is missed.
std::optional<MostMissed> most_missed(std::span<const AccuracyScene> scenes);

/// What finds contacts on a side of a page.
struct MissedSide {
  std::string title;
  PeopleDetectors detectors;  ///< one, whose contacts carry `kPagePlanes`
};

struct PageWords {
  std::string title;
  std::string about;  ///< stands below the title
};

/// Returns the page of 'vestige view' on which these two sides stand beside each other, over the whole scene, sampled
/// at `rate_hz`. Contacts that one side misses are marked in red.
std::string missed_page(const MovingScene& scene, const ActuatorMap& map, double rate_hz, std::vector<MissedSide> sides,
                        const PageWords& words);

}  // namespace vestige
