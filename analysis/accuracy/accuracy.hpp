#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "analysis/accuracy/event_score.hpp"
#include "analysis/accuracy/moving_scene.hpp"
#include "analysis/accuracy/true_contacts.hpp"
#include "analysis/run/skinning_error.hpp"
#include "detector/detector.hpp"

namespace vestige {

/// A detector, with a method, whose error is measured.
struct AccuracyContestant {
  std::string detector;
  Method method = Method::kStatic;
  std::unique_ptr<Detector> instance;  ///< its rows carry `Plane::kTime`
};

/// One detector with one method at one rate of the trace.
struct AccuracyPoint {
  std::size_t contestant = 0;
  double rate_hz = 0;
  std::uint64_t frames = 0;
  std::uint64_t contacts = 0;
  EventScore score;
  SkinningError skinning;        ///< of a few frames, evenly spread
  std::vector<double> frame_us;  ///< duration of every frame

  double total_s() const;
};

/// What was measured on one scene.
struct AccuracyScene {
  std::string colliders;  ///< as the user asked for them
  std::size_t collider_count = 0;
  TrueContacts truth;
  TrueContacts half;  ///< true contacts found at half the rate
  std::vector<AccuracyPoint> points;
};

/// Samples the scene at each rate, runs every contestant over the frames, and scores the events that the contestant
/// finds against the true events. A timing covers the whole round trip from a pose and collider positions to a row of
/// contacts, as in a sweep. The contestants take turns of a few frames each. Each turn shuffles their order anew, so
/// that other load on the machine affects all contestants alike.
///
/// Returns the points by rate, then by contestant. `progress` receives the share done and returns false to stop the
/// run. A stopped run returns only the points of the rates that are finished.
std::vector<AccuracyPoint> run_accuracy(const MovingScene& scene, const TrueContacts& truth,
                                        const std::vector<AccuracyContestant>& contestants,
                                        const std::vector<double>& rates_hz, std::uint64_t seed,
                                        const std::function<bool(double)>& progress);

}  // namespace vestige
