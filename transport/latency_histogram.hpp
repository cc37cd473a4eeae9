#pragma once

#include <array>
#include <cstdint>

namespace vestige {

/// Latencies in bounded memory, for streams that run for days: counts in classes 1 % wide, from 1 µs to 16 minutes.
class LatencyHistogram {
 public:
  void add(double latency_s);

  std::uint64_t count() const { return count_; }
  /// The value that `share` (0 … 1) of them do not exceed, in microseconds, 1 % high at most; 0 when there are none.
  double quantile_us(double share) const;
  double max_us() const { return max_us_; }

 private:
  static constexpr std::size_t kClasses = 2080;
  static double upper_end_us(std::size_t index);

  std::array<std::uint64_t, kClasses> counts_{};
  std::uint64_t count_ = 0;
  double max_us_ = 0;
};

}  // namespace vestige
