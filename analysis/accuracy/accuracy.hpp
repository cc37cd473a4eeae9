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

/// One of those whose error is measured.
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
  std::string colliders;  ///< as they were asked for
  std::size_t collider_count = 0;
  TrueContacts truth;
  TrueContacts half;  ///< the same at half the rate
  std::vector<AccuracyPoint> points;
};

/// Runs every contestant over the scene sampled at each rate, and scores the events that it finds against the true
/// ones. Timed is the whole round trip from a pose and collider positions to a row of contacts, as in a sweep. The
/// contestants take turns, a few frames each, in an order shuffled anew, so that whatever else the machine does hits
/// all alike.
///
/// Points by rate, then contestant. `progress` is told the share done and returns false to stop: then only rates that
/// were finished are returned.
std::vector<AccuracyPoint> run_accuracy(const MovingScene& scene, const TrueContacts& truth,
                                        const std::vector<AccuracyContestant>& contestants,
                                        const std::vector<double>& rates_hz, std::uint64_t seed,
                                        const std::function<bool(double)>& progress);

}  // namespace vestige
