#include "detector/actuators/pressure.hpp"

#include <algorithm>
#include <cmath>

namespace vestige {

double pressure_of(const Contact& contact) {
  const double share = contact.speed_m_per_s / kFullPressureSpeed_m_per_s;
  return share > 0 ? std::min(share, 1.0) : 0.0;  // not a number: 0
}

PressureLaw::PressureLaw(std::size_t actuator_count, double hold_s)
    : hold_s_(hold_s), held_(actuator_count), asked_(actuator_count) {
  frame_.duty.resize(actuator_count);
}

const ActuatorFrame& PressureLaw::next(double time_s, const ContactRow& row) {
  for (std::deque<Held>& held : held_)
    while (!held.empty() && time_s >= held.front().until_s) held.pop_front();
  for (const Contact& contact : row) {
    if (!contact.hit() || contact.actuator == 0) continue;
    const auto pressure = static_cast<std::uint8_t>(std::lround(255 * pressure_of(contact)));
    std::deque<Held>& held = held_[contact.actuator - 1U];
    while (!held.empty() && held.back().pressure <= pressure) held.pop_back();
    held.push_back({time_s + hold_s_, pressure});
  }
  frame_.time_s = time_s;
  for (std::size_t i = 0; i < held_.size(); ++i) asked_[i] = held_[i].empty() ? 0.0 : held_[i].front().pressure;
  const std::vector<double>& fired = firing_.apply(asked_, fired_);
  for (std::size_t i = 0; i < fired.size(); ++i) frame_.duty[i] = static_cast<std::uint8_t>(std::lround(fired[i]));
  return frame_;
}

}  // namespace vestige
