#pragma once

#include <memory>
#include <span>
#include <vector>

#include "detector/actuators/actuator_model.hpp"
#include "detector/actuators/intensity.hpp"
#include "traces/timeline/timeline.hpp"

namespace vestige {

/// Converts contacts to the duty cycles of a vest: a law's amplitudes, each passed through its motor's curve and
/// kick-start.
class ActuatorDrive {
 public:
  /// Without motors, a duty is 255 times the amplitude, rounded. Otherwise `motors` has one motor for each actuator.
  explicit ActuatorDrive(std::unique_ptr<IntensityLaw> law, std::vector<Motor> motors = {});

  /// Arguments as for `IntensityLaw::next`. The reference is valid until the next call.
  const ActuatorFrame& next(double time_s, std::span<const Contact> row, const DetectorFrame* frame = nullptr);

  IntensityLaw& law() { return *law_; }

 private:
  std::unique_ptr<IntensityLaw> law_;
  std::vector<Motor> motors_;
  std::vector<double> kick_until_s_;
  ActuatorFrame frame_;
};

/// Returns the duty of one motor at `time_s`. `duty_before` is the motor's previous duty. `kick_until_s` is state that
/// belongs to the motor.
std::uint8_t drive(const Motor& motor, double amplitude, double time_s, std::uint8_t duty_before, double& kick_until_s);

}  // namespace vestige
