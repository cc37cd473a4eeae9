#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/accuracy/event_score.hpp"
#include "analysis/accuracy/moving_scene.hpp"
#include "analysis/accuracy/touch_score.hpp"
#include "analysis/accuracy/true_contacts.hpp"
#include "analysis/base/statistics.hpp"
#include "analysis/run/skinning_error.hpp"
#include "detector/detector.hpp"

namespace vestige {

/// A detector, with a method, whose error is measured.
struct AccuracyContestant {
  std::string detector;
  Method method = Method::kStatic;
  std::unique_ptr<Detector> instance;  ///< its rows carry `Plane::kTime`
};

/// One detector with one method at one rate of the trace, over all seeds of a scene.
struct AccuracyPoint {
  std::size_t contestant = 0;
  double rate_hz = 0;
  std::uint64_t frames = 0;  ///< of one pass
  std::uint64_t contacts = 0;
  EventScore score;                        ///< by the rule of one test frame
  EventScore tolerated;                    ///< by the tolerance on the time of impact
  std::optional<TouchScore> touches = {};  ///< only of spheres
  SkinningError skinning;                  ///< of a few frames, evenly spread
  std::vector<double> frame_us;            ///< duration of every frame of every pass
  std::size_t seeds = 1;
  std::vector<Repetition> passes;            ///< all passes of one seed, then those of the next
  std::vector<Repetition> processor_passes;  ///< the same passes by the processor time of all threads

  /// Returns about half the width of the 95 % interval of the wrong events' share, by the rule whose interval is wider.
  /// NaN if there are too few colliders to tell.
  double precision() const;

  /// Adds what was measured with another seed.
  AccuracyPoint& operator+=(const AccuracyPoint& other);
};

/// What was measured on one scene.
struct AccuracyScene {
  std::string colliders;  ///< as the user asked for them
  std::size_t collider_count = 0;
  double duration_s = 0;  ///< of all seeds together
  std::vector<std::uint64_t> seeds;
  double truth_rate_hz = 0;
  std::uint64_t true_contacts = 0;
  std::uint64_t true_events = 0;
  std::uint64_t checked_frames = 0;  ///< of the truth, by `exact`: all agree
  std::uint64_t half_contacts = 0;   ///< at half the truth's rate
  std::uint64_t half_events = 0;
  std::optional<double> inside_s = {};  ///< only of spheres in a closed body (`inside_s`)
  EventScore half_score;                ///< of the events at half the rate, as if a detector had found them
  std::vector<AccuracyPoint> points;

  /// Adds what was measured with another seed, perhaps for some of the points only. But if this has no points yet, it
  /// takes those of `other`.
  AccuracyScene& operator+=(const AccuracyScene& other);
};

struct AccuracySettings {
  std::vector<double> rates_hz;
  double tolerance_s = 0.035;  ///< on the time of impact, the same for every rate
  std::size_t passes = 3;      ///< how often each frame is timed
  std::uint64_t seed = 1;      ///< of the order of turns
};

/// Samples the scene at each rate, runs the contestants with these indices (`which`) over the frames as often as asked
/// for, and scores the events that the contestant finds against the true events. A timing covers the whole round trip
/// from a pose and collider positions to a row of contacts, as in a sweep. The contestants take turns of a few frames
/// each. Each turn shuffles their order anew, so that other load on the machine affects all contestants alike.
///
/// Returns the points by rate, then in the order of `which`. `progress` receives the share done and returns false to
/// stop the run. A stopped run returns only the points of the rates that are finished.
std::vector<AccuracyPoint> run_accuracy(const MovingScene& scene, const TrueContacts& truth,
                                        const std::vector<AccuracyContestant>& contestants,
                                        const std::vector<std::size_t>& which, const AccuracySettings& settings,
                                        const std::function<bool(double)>& progress);

}  // namespace vestige
