#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace vestige {

/// A vibrator of a bHaptics device.
struct BhapticsPlace {
  std::string_view position;  ///< what bHaptics' Player calls the device, or the side of a vest: "VestFront"
  std::size_t index = 0;      ///< from 0 on
  bool operator==(const BhapticsPlace&) const = default;
};

/// Returns the vibrator of each actuator, by the actuator's name:
///
/// - "VestFront 0" … "VestFront 19", and likewise VestBack (20), Head, ForearmL, ForearmR (6), HandL, HandR, FootL and
///   FootR (3). Their sizes are those in the README of github.com/HerpDerpinstine/bHapticsOSC.
/// - "front 1-1" … "front 5-4" and "back 1-1" … "back 5-4", as the layout `torso40` calls row and column of a side.
/// - "1" … "40" or "actuator 1" … "actuator 40", the names of actuators without one: in the order of bhaptics_vest.hpp.
///
/// Throws `Error`, with `subject`, if a name is none of these, or if two actuators would be one vibrator.
std::vector<BhapticsPlace> bhaptics_places(const std::vector<std::string>& actuator_names, const std::string& subject);

}  // namespace vestige
