#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/base/statistics.hpp"
#include "detector/detector.hpp"
#include "detector/gl/gl_context.hpp"
#include "traces/scene/avatar.hpp"
#include "traces/trace_file/trace_reader.hpp"

namespace vestige {

/// Returns whether a detector promises the same bits as all others that do (detector/CONTRACT.md, 10).
bool promises_same_bits(std::string_view detector);

/// A detector that is measured against others.
struct Contestant {
  std::string detector;
  Skip skip = Skip::kOff;  ///< for the report only: `make` decides
  /// Makes the detector, able to deliver these planes. Called twice: for timing and for the hash.
  std::function<std::unique_ptr<Detector>(PlaneSet)> make;
  /// Makes the context in which the scene is drawn during measurement (`RenderThread`). Empty: the scene is not drawn.
  std::function<std::unique_ptr<GlContext>()> make_renderer_context = {};
};

struct SweepSettings {
  std::vector<std::uint32_t> counts;  ///< numbers of colliders: the first n of the trace, by id
  std::uint32_t runs = 5;             ///< number of evenly spaced places of the trace to measure
  std::uint32_t run_frames = 40;      ///< consecutive frames at each place
  double min_time_s = 1;              ///< least time for every point; the places are repeated until then
  std::uint64_t seed = 1;             ///< seed of the random order
};

/// Returns the number of places that do not overlap in a trace of so many frames: `settings.runs` or fewer.
std::uint32_t sweep_places(std::uint64_t trace_frames, const SweepSettings& settings);

/// One point of HAVE 2010 Fig. 2: the detection frequency for a number of colliders.
struct SweepPoint {
  std::uint32_t colliders = 0;
  std::vector<Repetition> repetitions;
  std::vector<double> frame_us;   ///< duration of every timed frame
  std::uint64_t pass_frames = 0;  ///< frames in one pass over the measured places
  std::uint64_t contacts = 0;     ///< contacts in one pass
  DetectorWork work;              ///< work of one pass
  std::string texture_hash;       ///< hash of one pass
  /// Results of one pass (one for each collider and frame) whose hit or actuator differs from the reference.
  std::uint64_t disagreements = 0;

  std::uint64_t skipped_timed = 0;    ///< timed frames that bounds alone showed to be without contact
  double skipped_us = 0;              ///< total duration of these frames
  std::uint64_t rendered_frames = 0;  ///< frames of the scene drawn during the measurement
  double rendered_s = 0;              ///< duration of that drawing

  double hz() const { return frequency_hz(repetitions); }
  double rendered_hz() const { return static_cast<double>(rendered_frames) / rendered_s; }
};

struct SweepSeries {
  std::string detector;
  Skip skip = Skip::kOff;
  Method method = Method::kStatic;
  bool approximate = false;
  GlInfo gl;
  std::optional<GlInfo> renderer;  ///< context that drew the scene during the measurement, if any
  std::vector<SweepPoint> points;
};

/// Measures every contestant at every count. Each round shuffles the order anew, so that other load on the machine
/// affects all alike. A timing covers the whole round trip from a pose and collider positions to a row of contacts:
/// joint palette, segments, skinning or upload, test, read-back. A timing excludes decoding the trace and hashing.
///
/// If the scene is drawn during the measurement of a contestant, it is measured in stretches of a fifth of a second, so
/// that the renderer's 90 Hz take effect. Outside of these stretches, the scene is not drawn.
///
/// Every timed row is compared with a reference: a row that was computed separately, with all planes that the hash
/// needs and with the most colliders. If hits or actuators of the two rows differ, the point counts it, or, if the
/// detector promises the same bits, this function throws `Error`. `progress` receives the share done, 0 … 1, and
/// returns false to stop. A stopped sweep returns what was measured so far, which may lack repetitions.
std::vector<SweepSeries> run_sweep(TraceReader& trace, const Avatar& avatar, const std::vector<Contestant>& contestants,
                                   const SweepSettings& settings, const std::function<bool(double)>& progress);

}  // namespace vestige
