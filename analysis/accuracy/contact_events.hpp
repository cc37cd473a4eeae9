#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "detector/contact.hpp"
#include "detector/frame.hpp"

namespace vestige {

/// A maximal run of consecutive frames in which one collider is in contact with skin of one actuator (0: skin that no
/// actuator covers, an actuator like any other here). No gap is bridged.
///
/// A contact is an instant, the crossing of a surface: entering the body and leaving it are two. A collider that passes
/// through in a hundred frames makes two events of one frame each; one that passes within a single frame makes one,
/// since a row holds one contact for each collider.
struct ContactEvent {
  std::uint32_t column = 0;  ///< of the collider: its rank
  std::uint16_t actuator = 0;
  std::uint64_t first_frame = 0;
  std::uint64_t last_frame = 0;
  double impact_s = 0;    ///< the instant of contact in the first frame, as t tells
  double last_s = 0;      ///< likewise in the last frame
  double reported_s = 0;  ///< the end of the first frame, when its contact is known

  friend bool operator==(const ContactEvent&, const ContactEvent&) = default;
};

/// Makes events of rows, and keeps nothing else of them.
class ContactEventFinder {
 public:
  /// Frames in ascending order, with rows that carry `Plane::kTime`.
  void add(const Frame& frame, const ContactRow& row);

  std::uint64_t contacts() const { return contacts_; }

  /// All events, by column, then by time. Ends those that last.
  std::vector<ContactEvent> take();

 private:
  std::vector<std::optional<ContactEvent>> open_;  // by column
  std::vector<ContactEvent> ended_;
  std::uint64_t contacts_ = 0;
};

/// The events of consecutive parts of one trace as those of the whole: an event that the end of a part cuts in two
/// becomes one. Parts in order of time; the result as `ContactEventFinder::take` gives it.
std::vector<ContactEvent> join_events(std::span<const std::vector<ContactEvent>> parts);

}  // namespace vestige
