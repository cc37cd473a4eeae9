#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "detector/contact.hpp"
#include "detector/frame.hpp"

namespace vestige {

/// A maximal run of consecutive frames in which one collider is in contact with skin of one actuator. Gaps are not
/// bridged. Skin that no actuator covers counts as actuator 0, which is treated like any other actuator here.
///
/// A contact is the instant at which a collider crosses the surface, so entering the body and leaving it are two
/// contacts. A collider that passes through the body in a hundred frames makes two events of one frame each. A collider
/// that passes through within a single frame makes one event, since a row holds one contact for each collider.
struct ContactEvent {
  std::uint32_t column = 0;  ///< the collider's rank
  std::uint16_t actuator = 0;
  std::uint64_t first_frame = 0;
  std::uint64_t last_frame = 0;
  double impact_s = 0;    ///< instant of the contact in the first frame, computed from its t
  double last_s = 0;      ///< instant of the contact in the last frame
  double reported_s = 0;  ///< end of the first frame: the contact is known from then on

  friend bool operator==(const ContactEvent&, const ContactEvent&) = default;
};

/// Turns rows into events. Keeps only the events, not the rows.
class ContactEventFinder {
 public:
  /// Adds a frame. Frames must ascend, and their rows must carry `Plane::kTime`.
  void add(const DetectorFrame& frame, const ContactRow& row);

  std::uint64_t contacts() const { return contacts_; }

  /// Returns all events, sorted by column and then by time. Ends the events that still last.
  std::vector<ContactEvent> take();

 private:
  std::vector<std::optional<ContactEvent>> open_;  // by column
  std::vector<ContactEvent> ended_;
  std::uint64_t contacts_ = 0;
};

/// Returns the events of one collider. `events` are in the order of `ContactEventFinder::take`.
std::span<const ContactEvent> events_of(std::span<const ContactEvent> events, std::uint32_t column);

/// Joins the events of consecutive parts of one trace. If the end of a part cuts an event in two, the two become one.
/// `parts` are in order of time. Returns the events in the order of `ContactEventFinder::take`.
std::vector<ContactEvent> join_events(std::span<const std::vector<ContactEvent>> parts);

}  // namespace vestige
