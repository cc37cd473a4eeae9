#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "analysis/base/statistics.hpp"

namespace vestige {

/// A mean over units (traces, subjects, …) and its confidence interval.
struct MeanInterval {
  double mean = 0;    ///< NaN if no unit has a value
  Interval interval;  ///< 95 %; NaN if there are too few units
  std::size_t n = 0;  ///< number of units that have a value
};

/// How a candidate compares with the best of the others.
struct LeaderTest {
  double difference = 0;  ///< its mean less the best one, with the sign of the values; 0 for the best
  Interval interval;      ///< 95 % of how far it is from the best, who is chosen anew in every resample
  double p = 1;           ///< of the difference, if all candidates were equally good
  double p_holm = 1;      ///< corrected for the number of comparisons (Holm 1979)
};

/// Bootstrap of means over units in strata. Each resample draws whole units, from each stratum as many as it has, and
/// the same units for every candidate. So strata are taken for fixed: what is resampled is what else a stratum could
/// have shown. What makes a unit hard for all candidates cancels in differences. Everything is divided by its standard
/// error before quantiles are taken (bootstrap-t; Davison & Hinkley 1997, sections 3.2, 4.4 and 5.2), since errors are
/// skewed, and units are few. NaN values are missing. The same input and seed give the same bits.
class StratifiedBootstrap {
 public:
  /// The stratum of each unit is a number from 0. Intervals exist only where every stratum has at least `kLeastUnits`,
  /// and all of them together `kLeastFreedom` more units than strata: eight units of one stratum, say.
  StratifiedBootstrap(std::span<const std::size_t> stratum_of_unit, std::uint64_t seed);

  static constexpr std::size_t kLeastUnits = 5;  ///< with three, intervals hold the truth in 98 %, not in 95 %
  static constexpr std::size_t kLeastFreedom = 7;
  static constexpr std::size_t kResamples = 10000;

  bool has_intervals() const { return !drawn_.empty(); }

  /// Returns the mean of `values`, one for each unit, and its interval. There is none if the units that have a value
  /// are fewer than the constructor asks for.
  MeanInterval mean(std::span<const double> values) const;

  /// Compares each candidate with the best of the others (Hsu 1984, Ann. Statist. 12:1136). `candidates` has a value
  /// for each unit of each candidate; `sign` is 1 if low values are better, otherwise -1. p: of the resamples in which
  /// chance alone puts a candidate behind the best, the share in which it is as far behind, in standard errors. Without
  /// intervals, and where a candidate has too few values, there is none.
  std::vector<std::optional<LeaderTest>> against_leader(std::span<const std::vector<double>> candidates,
                                                        double sign) const;

 private:
  /// A mean over strata, each with the weight of its units, and its standard error.
  struct Estimate {
    double mean = 0;   ///< NaN if there is no value
    double error = 0;  ///< NaN if a stratum has one value only
  };
  Estimate estimate(std::span<const double> values, std::span<const std::uint32_t> units) const;
  bool has_interval(std::span<const double> values) const;
  std::span<const std::uint32_t> resample(std::size_t i) const {
    return std::span(drawn_).subspan(i * stratum_of_unit_.size(), stratum_of_unit_.size());
  }

  std::vector<std::size_t> stratum_of_unit_;
  std::vector<std::vector<std::uint32_t>> units_of_;  ///< the units of each stratum
  std::vector<std::uint32_t> all_units_;              ///< stratum by stratum
  std::vector<std::uint32_t> drawn_;                  ///< the units of each resample, stratum by stratum
};

}  // namespace vestige
