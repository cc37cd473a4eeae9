#pragma once

namespace vestige {

/// Times in a trace are whole nanoseconds, those that people read or give are seconds.
inline constexpr double kNanosecondsPerSecond = 1e9;

}  // namespace vestige
