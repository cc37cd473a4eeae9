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
#include "detector/output/contacts_file.hpp"
#include "detector/output/recorded_contacts.hpp"
#include "detector/output/texture_exr.hpp"
#include "traces/timeline/timeline.hpp"
#include "traces/trace_file/trace_reader.hpp"

namespace vestige {

/// Where a replay's results go. A null output is left out.
struct ReplayOutputs {
  ContactsFile* contacts = nullptr;
  TextureExr* textures = nullptr;
  TimelineFile* timeline = nullptr;
  ActuatorDrive* drive = nullptr;  ///< makes the timeline's content; may be null only without a timeline
};

/// What a replay is compared with. At most one of the two is set.
struct ReplayExpectation {
  DetectorTeam* detectors = nullptr;                       ///< run on the same frames for comparison
  const std::vector<RecordedContact>* contacts = nullptr;  ///< contacts of an earlier run, frames ascend
};

/// Another actuator map, valid from a time of the trace on.
struct MapChange {
  double time_s = 0;
  ActuatorMap map;                               ///< has as many actuators as the trace's map
  std::shared_ptr<const ActuatorLayout> layout;  ///< the layout for the drive's law; null if the law needs none
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
  std::size_t map_changes = 0;  ///< how many of the changes asked for were reached
  std::uint64_t non_finite_frames = 0;
  std::uint64_t non_finite_segments = 0;
  std::optional<std::uint64_t> first_non_finite;    ///< index of the first frame with a non-finite pose or segment
  std::vector<std::uint64_t> contacts_of_actuator;  ///< [0]: contacts on skin that no actuator covers
  bool any_vibrates = false;                        ///< whether any actuator's duty was more than 0; of a timeline only
  std::string texture_hash;
  double reading_s = 0;  ///< decoding the trace
  /// Whole round trips; excludes decoding, which runs in parallel if there are several threads.
  double detection_s = 0;
  SkinningError skinning;  ///< of a few evenly spaced frames
  std::optional<Comparison> comparison;
  bool interrupted = false;
};

/// Runs all frames of `trace` through `detectors`. Their rows must carry what the outputs need and `kHashedPlanes`; if
/// `plan` has map changes, texture coordinates too. `progress` is told the share done and returns false to stop early.
ReplayResult replay(TraceReader& trace, DetectorTeam& detectors, const ReplayPlan& plan,
                    const std::function<bool(double)>& progress);

}  // namespace vestige
