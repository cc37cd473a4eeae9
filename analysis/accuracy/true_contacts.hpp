#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "analysis/accuracy/contact_events.hpp"
#include "analysis/accuracy/moving_scene.hpp"
#include "detector/detector.hpp"

namespace vestige {

/// The contacts of continuous motion, as far as a sampling rate shows them. Between two samples, `ccd` assumes that
/// skin and colliders move linearly.
struct TrueContacts {
  double rate_hz = 0;
  std::uint64_t contacts = 0;  ///< contacts in all rows; a sliding collider has one in every frame
  /// If the colliders are spheres, whole touches (`touches_of`).
  std::vector<ContactEvent> events;
  std::vector<ContactEvent> by_actuator;  ///< only of spheres: the parts of the touches, each with its actuator
};

/// Finds the true contacts on several threads. `make` returns a detector for each thread, and the detectors' rows must
/// carry `Plane::kTime`. The result does not depend on the number of threads. `progress` receives the share done and
/// returns false to stop the search. The result is then empty.
TrueContacts find_true_contacts(const MovingScene& scene, double rate_hz,
                                const std::function<std::unique_ptr<Detector>()>& make,
                                const std::function<bool(double)>& progress);

/// Which frames of the truth are checked, and by what.
struct TruthCheck {
  double rate_hz = 0;
  std::uint64_t frames = 0;  ///< whole frames, drawn by `seed`; all frames if there are fewer
  std::uint64_t seed = 1;
  std::function<std::unique_ptr<Detector>()> make;        ///< the detector that found the truth
  std::function<std::unique_ptr<Detector>()> make_exact;  ///< the one to compare with
};

/// Compares frames of the truth with the slow truth. Returns how many were compared. Throws `Error` if a contact
/// differs in hit, triangle or time: one of the two is wrong then. `progress` is as above; a stopped check returns 0.
std::uint64_t check_true_contacts(const MovingScene& scene, const TruthCheck& check,
                                  const std::function<bool(double)>& progress);

}  // namespace vestige
