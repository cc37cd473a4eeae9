#pragma once

#include <cstdint>
#include <vector>

#include "detector/contact.hpp"
#include "traces/timeline.hpp"

namespace vestige {

/// The paper's law: a contact switches its actuator fully on. `hold_s` keeps it on for that long after the contact,
/// since a coin motor cannot answer an instant; 0 gives the raw frames.
class BinaryLaw {
 public:
  BinaryLaw(std::size_t actuator_count, double hold_s);

  /// The actuators at `time_s`, given this frame's contacts. Times must not decrease. The reference stays good until
  /// the next call.
  const ActuatorFrame& next(double time_s, const ContactRow& row);

 private:
  double hold_s_;
  std::vector<double> on_until_s_;
  ActuatorFrame frame_;
};

}  // namespace vestige
