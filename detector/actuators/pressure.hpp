#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "detector/contact.hpp"
#include "traces/timeline/timeline.hpp"

namespace vestige {

/// A collider as fast as a push with the hand asks for all that a cell can give.
inline constexpr double kFullPressureSpeed_m_per_s = 1;

/// The share 0 … 1 of a pneumatic cell's range that a contact asks for: its speed along the triangle's normal, as a
/// share of `kFullPressureSpeed_m_per_s`, at most 1. A model, not a measurement: HAVE 2010 only names cell pressure as
/// something that a further target of its texture could carry.
double pressure_of(const Contact& contact);

/// Pressures 0 … 255 (in `ActuatorFrame::duty`) for pneumatic vests: 255 times the largest `pressure_of` the contacts
/// of an actuator's last `hold_s`, rounded. 0 gives the raw frames.
class PressureLaw {
 public:
  PressureLaw(std::size_t actuator_count, double hold_s);

  /// The actuators at `time_s`, given this frame's contacts, whose rows must carry `Plane::kPressure`. Times must not
  /// decrease. The reference stays good until the next call.
  const ActuatorFrame& next(double time_s, const ContactRow& row);

 private:
  struct Held {
    double until_s;
    std::uint8_t pressure;
  };

  double hold_s_;
  std::vector<std::deque<Held>> held_;  // for each actuator: the strongest first, and behind it what outlasts it
  ActuatorFrame frame_;
};

}  // namespace vestige
