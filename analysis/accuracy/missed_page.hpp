#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/accuracy/accuracy.hpp"
#include "analysis/accuracy/moving_scene.hpp"
#include "analysis/run/detector_team.hpp"
#include "analysis/view/page_packer.hpp"
#include "detector/actuator_map.hpp"

namespace vestige {

/// A place of a measurement.
struct MostMissed {
  const AccuracyScene* scene = nullptr;
  const AccuracyPoint* point = nullptr;
};

/// Returns the point that misses the largest share of its true events within the tolerance, of equal ones that which
/// misses more by the rule of one test frame. Exact ccd does not count. Returns nothing if nothing is missed.
std::optional<MostMissed> most_missed(std::span<const AccuracyScene> scenes,
                                      std::span<const AccuracyContestant> contestants);

/// How a scene is sampled, and which contacts of two sides are the same.
struct MissedSampling {
  double rate_hz = 0;
  double tolerance_s = 0;
};

/// What finds contacts on a side of a page.
struct MissedSide {
  std::string title;
  PeopleDetectors detectors;  ///< one, whose contacts carry `kPagePlanes`
};

struct MissedPage {
  PageContent content;                  ///< with all that `make_page` needs but `about`
  std::vector<std::uint64_t> contacts;  ///< of each side
};

/// Makes the page of 'vestige view' on which two sides stand beside each other, over the whole scene, sampled as
/// `sampling` says. Contacts that only one side has are marked in red. `progress` receives the share done; if it
/// returns false, nothing is returned.
std::optional<MissedPage> missed_page(const MovingScene& scene, const ActuatorMap& map, const MissedSampling& sampling,
                                      std::vector<MissedSide> sides, const std::function<bool(double)>& progress);

}  // namespace vestige
