#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace vestige {

/// The sides of a bHaptics vest, as .tact files and bHaptics' Player call them. Each has five rows of four vibrators,
/// with the indices 0 … 19 row by row. Actuators 1 … 20 are those of the front, and 21 … 40 those of the back: the
/// order of the layout `torso40`.
inline constexpr std::string_view kBhapticsSides[] = {"VestFront", "VestBack"};
inline constexpr std::size_t kBhapticsSideRows = 5;
inline constexpr std::size_t kBhapticsSideColumns = 4;
inline constexpr std::size_t kBhapticsSideActuators = kBhapticsSideRows * kBhapticsSideColumns;

/// Returns the intensity of bHaptics, 0 … 100, of a level of 0 … 255.
inline long bhaptics_intensity(std::uint8_t level) {
  return std::lround(level * 100 / 255.0);
}

}  // namespace vestige
