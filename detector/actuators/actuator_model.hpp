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

/// One vibration motor with an eccentric mass (ERM), as a model: not a measurement of anybody's vest.
struct Motor {
  /// What is told for an amplitude: the duty 0 … 255 at amplitude i / 255. A driver that makes up for its motor.
  std::array<std::uint8_t, 256> curve = straight();
  double dead_zone = 0;   ///< a motor that is told less than this share of full stands still; above, its vibration
                          ///< grows evenly from 0 to 1
  double rise_s = 0.060;  ///< time constant of spinning up: 95 % after three of them, 180 ms
  double fall_s = 0.060;  ///< and of spinning down
  double kick_s = 0;      ///< told full for so long when it starts from rest
  double felt_threshold = 0.1;  ///< of the amplitude: what the skin notices

  /// The duty for an amplitude 0 … 1.
  std::uint8_t duty(double amplitude) const;
  /// The amplitude 0 … 1 that a duty comes to in the end.
  double settled(std::uint8_t duty) const;
  /// The amplitude after `duration_s` of a duty, from `amplitude` on: a' = (settled - a) / τ, solved exactly, so that
  /// many short steps come to what one long step does.
  double after(double amplitude, std::uint8_t duty, double duration_s) const;

  /// 255 a, rounded.
  static std::array<std::uint8_t, 256> straight();
};

/// The motors of a vest.
///
/// As a file, all fields optional:
///   {"duty": {"gamma": 0.5}                        255 a^gamma; or
///    "duty": {"table": [[0, 0], [0.1, 0.4], [1, 1]]}   amplitude and share of full duty, straight lines between
///    "dead_zone": 0.2, "rise_ms": 60, "fall_ms": 60, "kick_ms": 0, "felt_threshold": 0.1,
///    "actuators": [{"name": "chest left", "rise_ms": 80}]}   what is different for one, by its name in the map
/// dead_zone and felt_threshold are shares 0 … 1; gamma is more than 0, rise_ms and fall_ms too; a table begins at
/// amplitude 0, ends at 1 and ascends in both. An amplitude of 0 is always duty 0.
class ActuatorModel {
 public:
  ActuatorModel() = default;
  explicit ActuatorModel(const Motor& all) : all_(all) {}

  /// A motor for each of the map's actuators. Throws `Error` for a name that the map does not have.
  std::vector<Motor> motors(const ActuatorMap& map) const;

  const Motor& all() const { return all_; }

 private:
  friend ActuatorModel parse_actuator_model(std::string_view json, std::string_view name);
  std::string name_;
  Motor all_;
  std::vector<std::pair<std::string, Motor>> named_;
};

/// Throws `Error` at `name` for text that is not as `ActuatorModel` says; unknown fields too, which would do nothing.
ActuatorModel parse_actuator_model(std::string_view json, std::string_view name);
ActuatorModel read_actuator_model(const std::string& file);

}  // namespace vestige
