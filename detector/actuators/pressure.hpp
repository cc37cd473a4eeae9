#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <utility>
#include <vector>

#include "detector/contact.hpp"
#include "detector/firing.hpp"
#include "traces/timeline/timeline.hpp"

namespace vestige {

/// A collider as fast as a push with the hand requests the full pressure of a cell.
inline constexpr double kFullPressureSpeed_m_per_s = 1;

/// Returns the share 0 … 1 of a pneumatic cell's range that a contact requests: its speed along the triangle's normal,
/// as a share of `kFullPressureSpeed_m_per_s`, at most 1. This is a model, not a measurement: HAVE 2010 only mentions
/// cell pressure as something that a further target of its texture could carry.
double pressure_of(const Contact& contact);

/// Pressures 0 … 255 (in `ActuatorFrame::duty`) for pneumatic vests: 255 times the largest `pressure_of` the contacts
/// of an actuator in the last `hold_s` seconds, rounded. If `hold_s` is 0, the result is the raw frames.
class PressureLaw {
 public:
  PressureLaw(std::size_t actuator_count, double hold_s);

  /// Continues with another map of equally many actuators; the held pressures stay.
  void change_map(Firing firing) { firing_ = std::move(firing); }

  /// Returns the actuators at `time_s`. `row` has this frame's contacts and must carry `Plane::kPressure`. Times must
  /// not decrease. The reference is valid until the next call.
  const ActuatorFrame& next(double time_s, const ContactRow& row);

 private:
  struct Held {
    double until_s;
    std::uint8_t pressure;
  };

  double hold_s_;
  std::vector<std::deque<Held>> held_;  // for each actuator: the strongest first, then the weaker ones that outlast it
  std::vector<double> asked_;
  std::vector<double> fired_;
  Firing firing_;
  ActuatorFrame frame_;
};

}  // namespace vestige
