#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/run/skinning_error.hpp"
#include "detector/actuators/actuator_drive.hpp"
#include "detector/detector.hpp"
#include "detector/frame.hpp"
#include "detector/output/contacts_hash.hpp"
#include "detector/output/texture_hash.hpp"
#include "traces/timeline/timeline.hpp"

namespace vestige {

/// Another actuator map, valid from a time of the trace on.
struct MapChange {
  double time_s = 0;
  ActuatorMap map;                               ///< has as many actuators as the person's map
  std::shared_ptr<const ActuatorLayout> layout;  ///< the layout for the drive's law; null if the law needs none
};

/// A person of a replay.
struct ReplayPerson {
  const Avatar& avatar;
  std::size_t actuator_count = 0;
  TimelineFile* timeline = nullptr;    ///< null: none is written
  ActuatorDrive* drive = nullptr;      ///< makes the timeline's content; may be null only without a timeline
  std::span<const MapChange> changes;  ///< ascending times; each says anew what actuator every contact has
};

/// What a replay found on one person.
struct PersonResult {
  std::uint64_t contacts = 0;
  std::uint64_t origin_changes = 0;
  std::size_t map_changes = 0;  ///< how many of the changes asked for were reached
  std::uint64_t non_finite_frames = 0;
  std::uint64_t non_finite_segments = 0;
  std::optional<std::uint64_t> first_non_finite;    ///< index of the first frame with a non-finite pose or segment
  std::vector<std::uint64_t> contacts_of_actuator;  ///< [0]: contacts on skin that no actuator covers
  bool any_vibrates = false;                        ///< whether any actuator's duty was more than 0; of a timeline only
  std::string texture_hash;
  std::string contacts_hash;  ///< by `ContactsHash`
  SkinningError skinning;     ///< of a few evenly spaced frames
};

/// Takes one person through a replay: builds the frames, and counts and turns into a timeline what was found in them.
class PersonReplay {
 public:
  /// `person` counts from 0. Frames are built as `detector` takes them. The plan is kept by reference.
  PersonReplay(const ReplayPerson& plan, std::size_t person, const Detector& detector);

  /// The colliders have taken this frame.
  const DetectorFrame& build(const TraceFrame& frame, const ColliderMoves& colliders) {
    return builder_.next(frame, colliders);
  }

  /// Compares how `detector` skins a frame. Does nothing if the pose is missing.
  void check_skinning(const TraceFrame& frame, const DetectorFrame& built, Detector& detector);

  /// Takes the row of a frame, whose columns belong to the colliders `ids`. After a change of the map it looks up the
  /// row's actuators anew, and those of `other`, the row of another detector, unless that is null.
  void take(const DetectorFrame& frame, ContactRow& row, ContactRow* other, std::span<const std::uint32_t> ids);

  PersonResult finish();

 private:
  void follow_map_changes(double time_s);

  const ReplayPerson& plan_;
  std::size_t person_;
  FrameBuilder builder_;
  const ActuatorMap* changed_map_ = nullptr;
  TextureHash hash_;
  ContactsHash contacts_hash_;
  PersonResult result_;
};

}  // namespace vestige
