#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/run/comparison.hpp"
#include "detector/actuators/actuator_drive.hpp"
#include "detector/detector.hpp"
#include "detector/frame.hpp"
#include "detector/output/recorded_contacts.hpp"
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
};

/// Turns the contacts of a file back into one person's rows, frame by frame.
class RecordedRows {
 public:
  /// Takes those of `contacts`, ordered by frame, whose avatar this is. `collider_ids` ascend and are those of the
  /// columns.
  RecordedRows(std::span<const RecordedContact> contacts, std::uint16_t avatar,
               std::span<const std::uint32_t> collider_ids);

  /// Frames must ascend. The reference is valid until the next call.
  const ContactRow& row_of(std::uint64_t frame);

  /// Returns the number of contacts whose frame or collider the trace does not have. It includes contacts that were
  /// never asked for.
  std::uint64_t strangers() const { return strangers_ + (contacts_.size() - next_); }

 private:
  std::vector<RecordedContact> contacts_;
  std::span<const std::uint32_t> collider_ids_;
  std::size_t next_ = 0;
  std::uint64_t strangers_ = 0;
  ContactRow row_;
};

/// Takes one person through a replay: builds the frames, and counts, compares and turns into a timeline what was found
/// in them.
class PersonReplay {
 public:
  /// `person` counts from 0. Frames are built as `detector` takes them. The plan, the ids and `expected` are kept by
  /// reference. `expected` are contacts to compare with, or null.
  PersonReplay(const ReplayPerson& plan, std::size_t person, std::span<const std::uint32_t> collider_ids,
               const Detector& detector, const std::vector<RecordedContact>* expected);

  const Avatar& avatar() const { return plan_.avatar; }
  const DetectorFrame& build(const TraceFrame& frame) { return builder_.next(frame); }

  /// Takes the row of a frame. After a change of the map it looks up the row's actuators anew. `other` is what another
  /// detector found, or null. What is compared is added to `comparison`.
  void take(const DetectorFrame& frame, ContactRow& row, ContactRow* other, Comparison* comparison);

  /// Ends the replay. If all frames were taken, what the file of contacts has beyond them is added to `comparison`.
  PersonResult finish(bool interrupted, Comparison* comparison);

 private:
  void follow_map_changes(double time_s);

  const ReplayPerson& plan_;
  FrameBuilder builder_;
  std::optional<RecordedRows> recorded_;
  const ActuatorMap* changed_map_ = nullptr;
  TextureHash hash_;
  PersonResult result_;
};

}  // namespace vestige
