#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

#include "traces/base/nanoseconds.hpp"

namespace vestige {

/// Thins frames for viewers: of each slot of 1 / rate seconds, the first frame is due.
class VizPace {
 public:
  explicit VizPace(double rate_hz) : rate_hz_(rate_hz) {}

  bool is_due(std::int64_t time_ns) const { return time_ns >= next_ns_; }
  /// Ends the slot of this frame, which was due. Times are rounded to whole nanoseconds, so that a frame may come 1 ns
  /// before the slot that it belongs to.
  void end_slot(std::int64_t time_ns) {
    constexpr double kEnd_ns = 0x1p63;  // of the numbers that fit
    const double slots = std::floor((static_cast<double>(time_ns) + 1) / kNanosecondsPerSecond * rate_hz_);
    const double next_ns = std::floor((slots + 1) / rate_hz_ * kNanosecondsPerSecond);
    next_ns_ = next_ns < kEnd_ns ? static_cast<std::int64_t>(next_ns) : std::numeric_limits<std::int64_t>::max();
  }

 private:
  double rate_hz_;
  std::int64_t next_ns_ = 0;
};

}  // namespace vestige
