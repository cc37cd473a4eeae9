#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace vestige {

/// The p-quantile (0 … 1) of `values` by linear interpolation between order statistics (Hyndman & Fan 1996, type 7).
/// NaN for no values.
double quantile(std::span<const double> values, double p);

/// One repetition of a measurement: how many frames took how long altogether.
struct Repetition {
  std::uint64_t frames = 0;
  double seconds = 0;
};

struct Interval {
  double low = 0;
  double high = 0;
};

/// Frames over total time, of all repetitions together. NaN for no time.
double frequency_hz(std::span<const Repetition> repetitions);

/// 95 % percentile bootstrap interval of `frequency_hz` (Efron & Tibshirani 1993, ch. 13), resampling whole
/// repetitions, since frames that follow each other are not independent. Seeded: the same input gives the same
/// interval.
Interval bootstrap_frequency_hz(std::span<const Repetition> repetitions, std::uint64_t seed);

/// Half the spread between the quartiles of the repetitions' frequencies over their median: the noise of a measurement.
/// 0 for fewer than two repetitions.
double relative_noise(std::span<const Repetition> repetitions);

}  // namespace vestige
