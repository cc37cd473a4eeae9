#include "detector/actuators/actuator_drive.hpp"

#include <cmath>
#include <limits>
#include <utility>

namespace vestige {

std::uint8_t drive(const Motor& motor, double amplitude, double time_s, std::uint8_t duty_before,
                   double& kick_until_s) {
  const std::uint8_t duty = motor.duty(amplitude);
  if (duty != 0 && duty_before == 0) kick_until_s = time_s + motor.kick_s;
  return duty != 0 && time_s < kick_until_s ? std::uint8_t{255} : duty;
}

ActuatorDrive::ActuatorDrive(std::unique_ptr<IntensityLaw> law, std::vector<Motor> motors)
    : law_(std::move(law)),
      motors_(std::move(motors)),
      kick_until_s_(motors_.size(), -std::numeric_limits<double>::infinity()) {
  frame_.duty.resize(law_->actuator_count());
}

const ActuatorFrame& ActuatorDrive::next(double time_s, std::span<const Contact> row, const DetectorFrame* frame) {
  const std::vector<double>& amplitude = law_->next(time_s, row, frame);
  frame_.time_s = time_s;
  for (std::size_t i = 0; i < amplitude.size(); ++i)
    frame_.duty[i] = motors_.empty() ? static_cast<std::uint8_t>(std::lround(255 * amplitude[i]))
                                     : drive(motors_[i], amplitude[i], time_s, frame_.duty[i], kick_until_s_[i]);
  return frame_;
}

}  // namespace vestige
