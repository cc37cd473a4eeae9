#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "detector/actuator_map.hpp"

namespace vestige {

/// A model of one vibration motor with an eccentric mass (ERM). It is not a measurement of any vest.
struct Motor {
  /// The duty 0 … 255 at amplitude i / 255: the correction that a driver applies for its motor.
  std::array<std::uint8_t, 256> curve = straight();
  double dead_zone = 0;   ///< a motor stands still at a duty up to this share of full; above it, the vibration grows
                          ///< linearly from 0 to 1
  double rise_s = 0.060;  ///< time constant of spinning up: 95 % after three time constants, 180 ms
  double fall_s = 0.060;  ///< time constant of spinning down
  double kick_s = 0;      ///< duration of full duty when the motor starts from rest
  double felt_threshold = 0.1;  ///< smallest amplitude that the skin notices

  /// Returns the duty for an amplitude 0 … 1.
  std::uint8_t duty(double amplitude) const;
  /// Returns the amplitude 0 … 1 that a constant duty reaches in the end.
  double settled(std::uint8_t duty) const;
  /// Returns the amplitude after `duration_s` of a constant duty, starting at `amplitude`: a' = (settled - a) / τ,
  /// solved exactly, so that many short steps equal one long step.
  double after(double amplitude, std::uint8_t duty, double duration_s) const;

  /// The curve with the duty 255 a, rounded.
  static std::array<std::uint8_t, 256> straight();
};

/// The motors of a vest.
///
/// As a file, all fields optional:
///   {"duty": {"gamma": 0.5}                        255 a^gamma; or
///    "duty": {"table": [[0, 0], [0.1, 0.4], [1, 1]]}   amplitude and share of full duty, interpolated
///    "dead_zone": 0.2, "rise_ms": 60, "fall_ms": 60, "kick_ms": 0, "felt_threshold": 0.1,
///    "actuators": [{"name": "chest left", "rise_ms": 80}]}   differences for one actuator, by its name in the map
/// dead_zone and felt_threshold are shares 0 … 1, but dead_zone is less than 1. gamma is 0.01 … 100. rise_ms and
/// fall_ms are more than 0, and they and kick_ms are 10000 at most. A table begins at amplitude 0 and ends at 1. Its
/// amplitudes ascend and its duties never descend. An amplitude of 0 always has duty 0.
class ActuatorModel {
 public:
  ActuatorModel() = default;
  explicit ActuatorModel(const Motor& all) : all_(all) {}

  /// Returns a motor for each of the map's actuators. Throws `Error` if the file names an actuator that the map does
  /// not have.
  std::vector<Motor> motors(const ActuatorMap& map) const;

  const Motor& all() const { return all_; }

 private:
  friend ActuatorModel parse_actuator_model(std::string_view json, std::string_view name);
  std::string name_;
  Motor all_;
  std::vector<std::pair<std::string, Motor>> named_;
};

/// Throws `Error`, which quotes `name`, if the text does not follow the format at `ActuatorModel`. Unknown fields are
/// errors too, because they would have no effect.
ActuatorModel parse_actuator_model(std::string_view json, std::string_view name);
ActuatorModel read_actuator_model(const std::string& file);

}  // namespace vestige
