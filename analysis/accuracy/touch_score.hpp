#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/accuracy/contact_events.hpp"

namespace vestige {

/// Joins the events of each sphere that follow each other without a frame between them, whatever their actuators: the
/// times in which it touches. All get actuator 0, so that they are compared without one. Events of points stay as they
/// are. `is_sphere` is by column. Takes and returns the order of `ContactEventFinder::take`.
std::vector<ContactEvent> touches_of(std::span<const ContactEvent> events, const std::vector<bool>& is_sphere);

/// How well a detector reports, frame by frame, whether spheres touch. Counts pairs of a frame and a sphere that are
/// more than one frame away from the beginning and the end of every true touch.
struct TouchScore {
  std::uint64_t within = 0;          ///< the sphere touches
  std::uint64_t reported = 0;        ///< of these: the detector reports a contact
  std::uint64_t wrong_actuator = 0;  ///< of these: with an actuator that no true contact of that time has
  std::uint64_t outside = 0;         ///< the sphere touches nothing
  std::uint64_t false_frames = 0;    ///< of these: the detector reports a contact

  TouchScore& operator+=(const TouchScore& other);
};

/// The sampling of what is scored, and of the truth.
struct TouchFrames {
  const std::vector<bool>& is_sphere;  ///< by column; points are not scored
  double rate_hz = 0;
  std::uint64_t last = 0;  ///< frames 1 to this one are scored
  double truth_rate_hz = 0;
};

/// Scores the events `test` against those of `truth`, both with actuators and in the order of
/// `ContactEventFinder::take`.
TouchScore score_touches(std::span<const ContactEvent> truth, std::span<const ContactEvent> test,
                         const TouchFrames& frames);

}  // namespace vestige
