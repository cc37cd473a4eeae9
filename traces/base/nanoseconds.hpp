#pragma once

namespace vestige {

/// Times in a trace are whole nanoseconds; times that people read or enter are seconds.
inline constexpr double kNanosecondsPerSecond = 1e9;

}  // namespace vestige
