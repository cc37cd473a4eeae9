#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "analysis/accuracy/contact_events.hpp"
#include "analysis/accuracy/moving_scene.hpp"
#include "detector/detector.hpp"

namespace vestige {

/// The contacts of continuous motion, as far as a rate of sampling shows them: between its samples `ccd` takes skin and
/// colliders to move linearly.
struct TrueContacts {
  double rate_hz = 0;
  std::uint64_t contacts = 0;  ///< rows' contacts; a collider that slides has one in every frame
  std::vector<ContactEvent> events;
};

/// Finds them with detectors that `make` makes, one for each of several threads; their rows must carry `Plane::kTime`.
/// The number of threads changes nothing. `progress` is told the share done and returns false to stop, which leaves the
/// result empty.
TrueContacts find_true_contacts(const MovingScene& scene, double rate_hz,
                                const std::function<std::unique_ptr<Detector>()>& make,
                                const std::function<bool(double)>& progress);

}  // namespace vestige
