#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <set>

#include "traces/scene/trace.hpp"

namespace vestige {

/// Drops frames so that at most a given rate is left: of the frames between two ticks, the first stays. The frames that
/// stay get consecutive new numbers, with a gap where frames were missing before. Teleports of a dropped frame move to
/// the next frame that stays.
class FrameThinning {
 public:
  explicit FrameThinning(double rate_hz) : rate_hz_(rate_hz) {}

  /// Returns whether the frame stays. If so, changes its number and its teleports.
  bool keep(TraceFrame& frame) {
    is_gap_ = is_gap_ || (last_index_ && frame.index != *last_index_ + 1);
    last_index_ = frame.index;
    teleported_.insert(frame.teleported.begin(), frame.teleported.end());
    // Times are rounded to nanoseconds, so a frame just before its tick counts as on the tick.
    constexpr double kTolerance = 1e-3;
    const double tick = std::floor(static_cast<double>(frame.time_ns) * rate_hz_ / 1e9 + kTolerance);
    if (last_tick_ && tick <= *last_tick_) return false;
    last_tick_ = tick;
    frame.teleported.assign(teleported_.begin(), teleported_.end());
    teleported_.clear();
    if (is_gap_) ++next_index_;
    is_gap_ = false;
    frame.index = next_index_++;
    return true;
  }

 private:
  double rate_hz_;
  std::optional<std::uint64_t> last_index_;
  std::optional<double> last_tick_;
  std::set<std::uint32_t> teleported_;
  bool is_gap_ = false;
  std::uint64_t next_index_ = 0;
};

}  // namespace vestige
