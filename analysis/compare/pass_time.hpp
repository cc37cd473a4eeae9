#pragma once

#include <cstddef>
#include <span>

namespace vestige {

/// How long one pass over the measured places takes at one point of a sweep, as far as other programs did not disturb
/// it.
struct PassTime {
  std::size_t passes = 0;   ///< complete passes
  double us = 0;            ///< sum over the pass's frames of the lower quartile of each frame's durations
  double error = 0;         ///< standard error of log(us); NaN for fewer than `kFewestPasses`
  std::size_t batches = 0;  ///< number of batches that `error` comes from: at most `kMostBatches`
  /// log(median / lower quartile), both summed as `us` is: how much repetitions of a frame scatter, at least 0.
  double scatter = 0;
};

/// The fewest passes from which `PassTime::error` is estimated.
inline constexpr std::size_t kFewestPasses = 8;
inline constexpr std::size_t kMostBatches = 10;
/// The most scatter of a usable measurement. Above it, most repetitions were disturbed, and so was the lower quartile:
/// by up to twice the time, on two cores with six other processes. At rest, scatter is 0.01 to 0.05.
inline constexpr double kMostScatter = 0.25;

/// Returns the typical pass of a point. `frame_us` are the durations of its frames in the order of measurement. Every
/// `pass_frames` frames, the same frames of the trace come again, so that each is compared with itself only. An
/// incomplete pass at the end is left out. The error is the jackknife's over batches of
/// consecutive passes, so that it grows with what changes slowly during the measurement (Efron & Tibshirani 1993, ch.
/// 11). Precondition: 0 < pass_frames <= frame_us.size().
PassTime pass_time(std::span<const double> frame_us, std::size_t pass_frames);

}  // namespace vestige
