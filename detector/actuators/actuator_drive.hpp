#pragma once

#include <memory>
#include <span>
#include <vector>

#include "detector/actuators/actuator_model.hpp"
#include "detector/actuators/intensity.hpp"
#include "traces/timeline/timeline.hpp"

namespace vestige {

/// Contacts in, what the vest is told out: a law's amplitudes, each through its motor's curve and kick-start.
class ActuatorDrive {
 public:
  /// Without motors, a duty is 255 times the amplitude, rounded. Else one for each actuator.
  explicit ActuatorDrive(std::unique_ptr<IntensityLaw> law, std::vector<Motor> motors = {});

  /// As `IntensityLaw::next`. The reference stays good until the next call.
  const ActuatorFrame& next(double time_s, std::span<const Contact> row);

  IntensityLaw& law() { return *law_; }

 private:
  std::unique_ptr<IntensityLaw> law_;
  std::vector<Motor> motors_;
  std::vector<double> kick_until_s_;
  ActuatorFrame frame_;
};

/// Turns amplitudes into duties: for one motor, what it is told at `time_s`. `kick_until_s` is the motor's own, and
/// `duty_before` what it was told before.
std::uint8_t drive(const Motor& motor, double amplitude, double time_s, std::uint8_t duty_before, double& kick_until_s);

}  // namespace vestige
