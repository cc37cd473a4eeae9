#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/base/statistics.hpp"
#include "detector/detector.hpp"
#include "detector/gl/gl_context.hpp"
#include "traces/scene/avatar.hpp"
#include "traces/trace_file/trace_reader.hpp"

namespace vestige {

/// One of those that are measured against each other.
struct Contestant {
  std::string detector;
  Skip skip = Skip::kOff;  ///< only told: `make` knows
  /// Makes it, able to deliver these planes. Called twice: for timing and for the hash.
  std::function<std::unique_ptr<Detector>(PlaneSet)> make;
  /// Makes the context in which the scene is drawn meanwhile (`RenderThread`); empty: nothing is drawn.
  std::function<std::unique_ptr<GlContext>()> make_renderer_context = {};
};

struct SweepSettings {
  std::vector<std::uint32_t> counts;  ///< of colliders: the first n of the trace, by id
  std::uint32_t runs = 5;             ///< places of the trace, evenly spread, that are measured
  std::uint32_t run_frames = 40;      ///< consecutive frames at each place
  double min_time_s = 1;              ///< spent on every point; the places are repeated until then
  std::uint64_t seed = 1;             ///< of the random order
};

/// The places that do not overlap in a trace of so many frames: `settings.runs`, or fewer.
std::uint32_t sweep_places(std::uint64_t trace_frames, const SweepSettings& settings);

/// HAVE 2010 Fig. 2, one point: detection frequency for a number of colliders.
struct SweepPoint {
  std::uint32_t colliders = 0;
  std::vector<Repetition> repetitions;
  std::vector<double> frame_us;   ///< duration of every frame timed
  std::uint64_t pass_frames = 0;  ///< frames in one pass over the measured places
  std::uint64_t contacts = 0;     ///< in one such pass
  DetectorWork work;              ///< likewise
  std::string texture_hash;       ///< likewise

  std::uint64_t skipped_timed = 0;    ///< of `frame_us`, those that bounds alone told to be without contact
  double skipped_us = 0;              ///< how long they took altogether
  std::uint64_t rendered_frames = 0;  ///< of the scene, while this was measured
  double rendered_s = 0;              ///< how long that took

  double hz() const { return frequency_hz(repetitions); }
  double rendered_hz() const { return static_cast<double>(rendered_frames) / rendered_s; }
};

struct SweepSeries {
  std::string detector;
  Skip skip = Skip::kOff;
  Method method = Method::kStatic;
  GlInfo gl;
  std::optional<GlInfo> renderer;  ///< where the scene was drawn meanwhile, if it was
  std::vector<SweepPoint> points;
};

/// Measures every contestant at every count, in an order shuffled anew for each round, so that whatever else the
/// machine does hits all alike. Timed is the whole round trip from a pose and collider positions to a row of contacts:
/// joint palette, segments, skinning or upload, test, read-back. Not timed: decoding the trace, hashing.
///
/// A contestant beside whom the scene is drawn is measured in stretches of a fifth of a second, so that the renderer's
/// 90 Hz show; outside of them nothing is drawn.
///
/// Every timed row is compared with one that was computed apart, with all planes that the hash needs; `Error` if they
/// disagree. `progress` is told the share done, 0 … 1, and returns false to stop: then what was measured so far is
/// returned, and may lack repetitions.
std::vector<SweepSeries> run_sweep(TraceReader& trace, const Avatar& avatar, const std::vector<Contestant>& contestants,
                                   const SweepSettings& settings, const std::function<bool(double)>& progress);

}  // namespace vestige
