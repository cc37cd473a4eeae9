#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace vestige {

/// Records latencies in bounded memory, for streams that run for days: counts in classes 1 % wide, from 1 µs to 16
/// minutes.
class LatencyHistogram {
 public:
  void add(double latency_s);
  LatencyHistogram& operator+=(const LatencyHistogram& other);

  std::uint64_t count() const { return count_; }
  /// Returns the value, in microseconds, that a fraction `share` (0 … 1) of the latencies does not exceed. It is at
  /// most 1 % too high; 0 if there are no latencies.
  double quantile_us(double share) const;
  double max_us() const { return max_us_; }
  /// Calls `take` with each class that is not empty, in order: its upper end, in microseconds, and its count.
  template <typename Take>
  void for_each_class(const Take& take) const {
    for (std::size_t i = 0; i < kClasses; ++i)
      if (counts_[i] != 0) take(upper_end_us(i), counts_[i]);
  }

 private:
  static constexpr std::size_t kClasses = 2080;
  static double upper_end_us(std::size_t index);

  std::array<std::uint64_t, kClasses> counts_{};
  std::uint64_t count_ = 0;
  double max_us_ = 0;
};

}  // namespace vestige
