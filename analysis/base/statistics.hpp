#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace vestige {

/// Stands for a missing value.
inline constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

/// Returns the p-quantile (0 … 1) of `values` by linear interpolation between order statistics (Hyndman & Fan 1996,
/// type 7). NaN for no values.
double quantile(std::span<const double> values, double p);

/// One repetition of a measurement: the number of frames and their total time.
struct Repetition {
  std::uint64_t frames = 0;
  double seconds = 0;
};

struct Interval {
  double low = 0;
  double high = 0;
};

/// Returns the 95 % interval of the share of errors among independent cases (Wilson 1927, Journal of the American
/// Statistical Association 22:209). No error in n cases gives [0, 3.84 / (n + 3.84)]. Precondition: errors <= cases,
/// and cases > 0.
Interval wilson_interval(std::uint64_t errors, std::uint64_t cases);

/// Returns frames over total time, of all repetitions together. NaN if the time is 0.
double frequency_hz(std::span<const Repetition> repetitions);

/// Returns the 95 % percentile bootstrap interval of `frequency_hz` (Davison & Hinkley 1997, section 3.2). Repetition r
/// measured place r % `places`. Places cost differently, and all of them are measured equally often. So what is
/// resampled is by how much each repetition differs from the mean of its place, for all places together, and for whole
/// repetitions, since consecutive frames are not independent. NaN if no place was measured twice, or if the times are
/// so scattered that the interval would hold a time of 0. The same input and `seed` give the same interval.
/// Precondition: places > 0.
Interval bootstrap_frequency_hz(std::span<const Repetition> repetitions, std::size_t places, std::uint64_t seed);

/// Returns the noise of a measurement: half the interquartile range of the repetitions' times, each over the mean of
/// its place (as in `bootstrap_frequency_hz`). 0 if no place was measured twice.
double relative_noise(std::span<const Repetition> repetitions, std::size_t places);

/// Part of a whole in one cluster: errors of all true events of one collider, say.
struct ClusterShare {
  double part = 0;
  double whole = 0;
};

/// Returns the 95 % interval of sum(part) / sum(whole) by the bootstrap, for what is independent only between clusters
/// (Davison & Hinkley 1997, section 2.4). It resamples whole clusters, with the levels of `expanded_level`. Clusters
/// that all agree do not tell how clusters differ: if none has a part, the interval is [0, 3 / n], at most 1, n being
/// the number of clusters with a whole ("rule of three", Hanley & Lippman-Hand 1983); if in all of them the part is the
/// whole, it is [1 - 3 / n, 1]. NaN if no cluster has a whole, or if only one has it and its part is neither 0 nor the
/// whole. The same input and `seed` give the same interval.
Interval bootstrap_share(std::span<const ClusterShare> clusters, std::uint64_t seed);

/// Returns the standard error of sum(part) / sum(whole) by linearisation (Cochran 1977, Sampling Techniques, eq. 6.13),
/// for what is independent only between clusters. Quick, and good enough to see whether there are enough clusters.
/// Where all clusters agree, 1.96 times it is half the interval of `bootstrap_share`. NaN if no cluster has a whole, or
/// if only one has it.
double share_standard_error(std::span<const ClusterShare> clusters);

/// Returns the quantile at which an expanded 95 % percentile interval of `n` values begins: Phi(-sqrt(n / (n-1))
/// t(0.975, n-1)). The values come from a table, and from 20 on from an approximation to 0.0001, since the functions of
/// that formula differ between machines in the last bit. Returns 0 for fewer than four values: the interval is then
/// their whole range.
double expanded_level(std::size_t n);

}  // namespace vestige
