#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/run/comparison.hpp"
#include "analysis/run/detector_team.hpp"
#include "analysis/run/skinning_error.hpp"
#include "detector/actuators/actuator_drive.hpp"
#include "detector/detector.hpp"
#include "detector/output/contacts_csv.hpp"
#include "detector/output/texture_exr.hpp"
#include "traces/timeline/timeline.hpp"
#include "traces/trace_file/trace_reader.hpp"

namespace vestige {

/// Where a replay's results go; what is null goes nowhere.
struct ReplayOutputs {
  ContactsCsv* contacts = nullptr;
  TextureExr* textures = nullptr;
  TimelineFile* timeline = nullptr;
  ActuatorDrive* drive = nullptr;  ///< what the timeline holds; null only without one
};

/// What a replay is compared with, at most one of the two.
struct ReplayExpectation {
  DetectorTeam* detectors = nullptr;                       ///< run beside, on the same frames
  const std::vector<RecordedContact>* contacts = nullptr;  ///< of an earlier run, ascending frames
};

/// Another actuator map from a time of the trace on.
struct MapChange {
  double time_s = 0;
  ActuatorMap map;                               ///< of as many actuators as the trace's
  std::shared_ptr<const ActuatorLayout> layout;  ///< what the drive's law goes on with; null for one that needs none
};

/// What to do with every frame of a trace.
struct ReplayPlan {
  const Avatar& avatar;
  std::size_t actuator_count;
  ReplayOutputs outputs;
  ReplayExpectation expectation;
  std::span<const MapChange> changes;  ///< ascending times; each says anew what actuator every contact has
};

struct ReplayResult {
  std::uint64_t frames = 0;
  std::uint64_t contacts = 0;
  DetectorWork work;
  std::uint64_t origin_changes = 0;
  std::size_t map_changes = 0;  ///< of those asked for, how many were reached
  std::uint64_t non_finite_frames = 0;
  std::uint64_t non_finite_segments = 0;
  std::optional<std::uint64_t> first_non_finite;    ///< index of the first frame with any of either
  std::vector<std::uint64_t> contacts_of_actuator;  ///< [0]: on skin that no actuator covers
  std::string texture_hash;
  double reading_s = 0;    ///< decoding the trace
  double detection_s = 0;  ///< whole round trips; decoding is apart, but beside it where there are several threads
  SkinningError skinning;  ///< of a few frames, evenly spread
  std::optional<Comparison> comparison;
  bool interrupted = false;
};

/// Runs all frames of `trace` through `detectors`. Their rows must carry what the outputs need and `kHashedPlanes`; if
/// `plan` has map changes, texture coordinates too. `progress` is told the share done and returns false to stop early.
ReplayResult replay(TraceReader& trace, DetectorTeam& detectors, const ReplayPlan& plan,
                    const std::function<bool(double)>& progress);

}  // namespace vestige
