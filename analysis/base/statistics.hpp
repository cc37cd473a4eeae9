#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace vestige {

/// Stands for a value that there is none of.
inline constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

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

/// A mean over units (traces, subjects, …) and how far it can be trusted.
struct MeanInterval {
  double mean = 0;    ///< NaN for no value
  Interval interval;  ///< 95 %; NaN for fewer than two values
  std::size_t n = 0;  ///< units that have a value
};

/// Bootstrap of means over the same units for many candidates: each resample draws whole units, the same ones for every
/// candidate, so that what makes a unit hard for all of them cancels in differences (Efron & Tibshirani 1993, ch. 8).
/// Values that are NaN are missing. The quantiles are moved outwards for few units, where the plain percentile
/// interval is too narrow ("expanded percentile", Hesterberg 2015, The American Statistician 69:371, section 5.2).
/// Seeded: the same input gives the same bits.
class PairedBootstrap {
 public:
  PairedBootstrap(std::size_t units, std::uint64_t seed);

  /// `values`: one for each unit.
  MeanInterval mean(std::span<const double> values) const;

  /// Of `values` - `others`, over the units that have both.
  MeanInterval difference(std::span<const double> values, std::span<const double> others) const;

 private:
  std::size_t units_;
  std::vector<std::uint32_t> drawn_;  // resample by resample, `units_` each
};

/// The quantile at which an expanded 95 % percentile interval of `n` values begins: Phi(-sqrt(n / (n-1)) t(0.975,
/// n-1)), from a table, since its functions differ between machines in the last bit. 0 for fewer than four: their whole
/// range.
double expanded_level(std::size_t n);

}  // namespace vestige
