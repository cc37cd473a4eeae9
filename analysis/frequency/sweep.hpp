#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/base/statistics.hpp"
#include "analysis/frequency/stage_pass.hpp"
#include "analysis/frequency/sweep_sample.hpp"
#include "analysis/frequency/sweep_scene.hpp"
#include "detector/detector.hpp"
#include "detector/gl/gl_context.hpp"
#include "traces/scene/avatar.hpp"
#include "traces/trace_file/trace_reader.hpp"

namespace vestige {

/// Returns whether a detector promises the same bits as all others that do (detector/CONTRACT.md, 10).
bool promises_same_bits(std::string_view detector);

/// A person of the trace that is measured.
struct SweptPerson {
  const Avatar& avatar;
  const ActuatorMap& map;
};

/// Makes a detector that is able to deliver these planes. It keeps references to avatar and map.
using ContestantMaker = std::function<std::unique_ptr<Detector>(const Avatar&, const ActuatorMap&, PlaneSet)>;

/// A detector that is measured against others.
struct Contestant {
  std::string detector;
  Skip skip = Skip::kOff;  ///< for the report only: `make` decides
  PlaneSet planes = {};    ///< the planes that it delivers during the measurement
  ContestantMaker make;    ///< called twice for each person of the crowd: for timing and for the hash
  /// Makes the context in which the scene is drawn during measurement (`RenderThread`). Empty: the scene is not drawn.
  std::function<std::unique_ptr<GlContext>()> make_renderer_context = {};
  Crowd crowd = {};
};

struct SweepSettings {
  std::vector<std::uint32_t> counts;  ///< numbers of colliders, each drawn from all colliders of the trace
  std::uint32_t runs = 4;             ///< number of evenly spaced places of the trace to measure
  std::uint32_t run_frames = 100;     ///< consecutive frames at each place, the first of them cold
  double min_time_s = 1;              ///< least time for every point; the places are repeated until then
  std::uint64_t seed = 1;             ///< seed of the drawn colliders and of the random order
  bool stages = false;                ///< afterwards, measure where the time goes (`measure_stages`)
  /// Also measure the throughput with this number of frames in flight. 0: do not. Not beside a renderer.
  std::uint32_t in_flight = 0;
};

/// One point of HAVE 2010 Fig. 2: the detection frequency for a number of colliders, of which each copy of a crowd may
/// have as many. At every place, other colliders are drawn. One pass measures every place once, with the colliders
/// drawn for it.
struct SweepPoint {
  std::uint32_t colliders = 0;
  /// The first pass. The detector has seen the first frames of every place before, but the caches hold nothing of it.
  std::vector<Repetition> cold;
  std::vector<Repetition> repetitions;  ///< further passes: repetition r measured place r % places
  std::size_t places = 0;               ///< number of places in one pass
  std::vector<double> frame_us;         ///< duration of every frame of the further passes
  std::uint64_t pass_frames = 0;        ///< frames in one pass
  std::uint64_t results = 0;            ///< results of one pass: one for each person, collider and frame
  std::uint64_t contacts = 0;           ///< contacts in one pass
  std::uint64_t empty_frames = 0;       ///< frames in which nobody has a contact, in one pass
  DetectorWork work;                    ///< work of one pass
  std::string texture_hash;             ///< `texture_hash_of` the people's hashes of one pass
  /// Results of one pass whose hit or actuator differs from the reference.
  std::uint64_t disagreements = 0;

  std::uint64_t skipped_timed = 0;    ///< frames of the further passes that bounds alone showed to be without contact
  double skipped_us = 0;              ///< total duration of these frames
  std::uint64_t rendered_frames = 0;  ///< frames of the scene drawn during the measurement
  double rendered_s = 0;              ///< duration of that drawing

  /// What `detector_memory_bytes` returned, where it was asked.
  std::optional<std::uint64_t> memory_bytes;

  StageMeans stages;  ///< empty unless asked for, and beside a renderer

  /// Passes of their own, in which the detectors are given spans of `in_flight` frames. Empty unless asked for, and
  /// beside a renderer.
  std::vector<Repetition> spanned;
  std::uint32_t in_flight = 0;  ///< as in the settings

  /// Of one frame after another, so 1 / hz is how long a frame takes: the latency.
  double hz() const { return frequency_hz(repetitions); }
  double throughput_hz() const { return frequency_hz(spanned); }
  double cold_hz() const { return frequency_hz(cold); }
  /// Mean duration of a frame. NaN where nothing was measured.
  double mean_us() const;
  double rendered_hz() const { return static_cast<double>(rendered_frames) / rendered_s; }
};

struct SweepSeries {
  /// Whether both were measured on the same people and colliders.
  bool same_crowd(const SweepSeries& other) const { return people == other.people && first_only == other.first_only; }

  std::string detector;
  Skip skip = Skip::kOff;
  Method method = Method::kStatic;
  bool approximate = false;
  std::optional<std::size_t> triangles_kept;  ///< as in Detector
  PlaneSet planes;
  std::uint32_t people = 1;  ///< measured at once, each by a detector of their own
  bool first_only = false;   ///< as in Crowd
  GlInfo gl;
  std::optional<GlInfo> renderer;  ///< context that drew the scene during the measurement, if any
  std::vector<SweepPoint> points;
};

struct Sweep {
  std::vector<SweepSeries> series;
  std::uint32_t places = 0;        ///< `settings.runs`, or as many as the trace has room for
  std::uint32_t place_frames = 0;  ///< frames measured at each: `settings.run_frames`, or those that the trace has
  std::string sample_sha256;       ///< as in SweepSample
  FrameContacts trace;             ///< of the whole trace, with all its colliders
  FrameContacts sampled;           ///< of the frames that were measured, with all colliders of the trace
};

/// Measures every contestant at every count, on frames (`sample_places`, by the contacts that a detector of `survey`
/// finds) and colliders (`draw_colliders`) that are the same for all. `people` are all of the trace. Each round
/// shuffles the order anew, so that other load on the machine affects all alike. A timing covers the whole round trip
/// from a pose and collider positions to a row of contacts: joint palette, segments, skinning or upload, test,
/// read-back. A timing excludes decoding the trace and hashing. Every point is measured in whole passes, and at least
/// twice after the first.
///
/// If the scene is drawn during the measurement of a contestant, it is measured in stretches of a fifth of a second, so
/// that the renderer's 90 Hz take effect. Outside of these stretches, the scene is not drawn. Precondition: the trace
/// then has one person, and the crowd one copy.
///
/// Throughput is measured in passes of its own, over the same frames and in the same rounds: spans of frames are given
/// to the detector at once (`Detector::detect_all`). Building those frames belongs to the time.
///
/// Every timed row is compared with a reference: a row that was computed separately, with all planes that the hash
/// needs and with all colliders that were drawn at this place for any count. If hits or actuators of the two rows
/// differ, the point counts it, or, if the detector promises the same bits, this function throws `Error`. `progress`
/// receives the share done, 0 … 1, and returns false to stop. A stopped sweep returns what was measured so far, which
/// may lack repetitions.
Sweep run_sweep(TraceReader& trace, std::span<const SweptPerson> people, const ContestantMaker& survey,
                const std::vector<Contestant>& contestants, const SweepSettings& settings,
                const std::function<bool(double)>& progress);

}  // namespace vestige
