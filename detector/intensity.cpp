#include "detector/intensity.hpp"

#include <limits>

namespace vestige {

BinaryLaw::BinaryLaw(std::size_t actuator_count, double hold_s)
    : hold_s_(hold_s), on_until_s_(actuator_count, -std::numeric_limits<double>::infinity()) {
  frame_.duty.resize(actuator_count);
}

const ActuatorFrame& BinaryLaw::next(double time_s, const ContactRow& row) {
  frame_.time_s = time_s;
  for (std::size_t i = 0; i < frame_.duty.size(); ++i) frame_.duty[i] = time_s < on_until_s_[i] ? 255 : 0;
  for (const Contact& contact : row) {
    if (!contact.hit() || contact.actuator == 0) continue;
    const std::size_t i = contact.actuator - 1U;
    frame_.duty[i] = 255;
    on_until_s_[i] = time_s + hold_s_;
  }
  return frame_;
}

}  // namespace vestige
