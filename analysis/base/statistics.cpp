#include "analysis/base/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <random>

namespace vestige {

namespace {

constexpr int kResamples = 1000;

/// How the repetitions of a measurement differ from what their places cost.
struct Residuals {
  std::vector<double> expected_s;  ///< for each repetition: its frames at the mean of its place
  /// Time over expected time, less 1, of every repetition whose place was measured more than once. Widened, since a
  /// mean lies in the middle of what it is the mean of.
  std::vector<double> relative;
};

Residuals residuals(std::span<const Repetition> repetitions, std::size_t places) {
  Residuals found;
  found.expected_s.resize(repetitions.size());
  for (std::size_t place = 0; place < std::min(places, repetitions.size()); ++place) {
    double frames = 0;
    double seconds = 0;
    double count = 0;
    for (std::size_t r = place; r < repetitions.size(); r += places) {
      frames += static_cast<double>(repetitions[r].frames);
      seconds += repetitions[r].seconds;
      ++count;
    }
    for (std::size_t r = place; r < repetitions.size(); r += places) {
      found.expected_s[r] = static_cast<double>(repetitions[r].frames) * seconds / frames;
      if (count > 1 && seconds > 0)
        found.relative.push_back((repetitions[r].seconds / found.expected_s[r] - 1) * std::sqrt(count / (count - 1)));
    }
  }
  return found;
}

}  // namespace

double quantile(std::span<const double> values, double p) {
  if (values.empty()) return kMissing;
  std::vector<double> parted(values.begin(), values.end());
  const double place = p * static_cast<double>(parted.size() - 1);
  const auto below = parted.begin() + static_cast<std::ptrdiff_t>(place);
  std::ranges::nth_element(parted, below);
  const double above = below + 1 == parted.end() ? *below : *std::min_element(below + 1, parted.end());
  return *below + (place - std::floor(place)) * (above - *below);
}

Interval wilson_interval(std::uint64_t errors, std::uint64_t cases) {
  constexpr double kZSquared = 1.959963984540054 * 1.959963984540054;
  const auto n = static_cast<double>(cases);
  const double share = static_cast<double>(errors) / n;
  const double middle = (share + kZSquared / (2 * n)) / (1 + kZSquared / n);
  const double half = std::sqrt(kZSquared * (share * (1 - share) / n + kZSquared / (4 * n * n))) / (1 + kZSquared / n);
  // At both ends, rounding must not leave a little.
  return {errors == 0 ? 0 : middle - half, errors == cases ? 1 : middle + half};
}

double frequency_hz(std::span<const Repetition> repetitions) {
  double frames = 0;
  double seconds = 0;
  for (const Repetition& repetition : repetitions) {
    frames += static_cast<double>(repetition.frames);
    seconds += repetition.seconds;
  }
  return seconds > 0 ? frames / seconds : kMissing;
}

Interval bootstrap_frequency_hz(std::span<const Repetition> repetitions, std::size_t places, std::uint64_t seed) {
  const Residuals found = residuals(repetitions, places);
  if (found.relative.empty()) return {kMissing, kMissing};
  double frames = 0;
  for (const Repetition& repetition : repetitions) frames += static_cast<double>(repetition.frames);
  std::mt19937_64 random(seed);
  std::vector<double> times_s;
  times_s.reserve(kResamples);
  for (int i = 0; i < kResamples; ++i) {
    double seconds = 0;
    for (const double expected_s : found.expected_s)
      seconds += expected_s * (1 + found.relative[random() % found.relative.size()]);
    times_s.push_back(seconds);
  }
  const double shortest_s = quantile(times_s, 0.025);
  if (shortest_s <= 0) return {kMissing, kMissing};
  return {frames / quantile(times_s, 0.975), frames / shortest_s};
}

Interval bootstrap_share(std::span<const ClusterShare> clusters, std::uint64_t seed) {
  const auto with_whole = std::ranges::count_if(clusters, [](const ClusterShare& share) { return share.whole > 0; });
  if (with_whole == 0) return {kMissing, kMissing};
  const double three = std::min(1.0, 3 / static_cast<double>(with_whole));
  if (std::ranges::all_of(clusters, [](const ClusterShare& share) { return share.part == 0; })) return {0, three};
  if (std::ranges::all_of(clusters, [](const ClusterShare& share) { return share.part == share.whole; }))
    return {1 - three, 1};
  if (with_whole < 2) return {kMissing, kMissing};
  std::mt19937_64 random(seed);
  std::vector<double> shares;
  for (int i = 0; i < kResamples; ++i) {
    ClusterShare sum;
    for (std::size_t k = 0; k < clusters.size(); ++k) {
      const ClusterShare& drawn = clusters[random() % clusters.size()];
      sum.part += drawn.part;
      sum.whole += drawn.whole;
    }
    if (sum.whole > 0) shares.push_back(sum.part / sum.whole);
  }
  const double level = expanded_level(static_cast<std::size_t>(with_whole));
  return {quantile(shares, level), quantile(shares, 1 - level)};
}

double share_standard_error(std::span<const ClusterShare> clusters) {
  ClusterShare sum;
  double with_whole = 0;
  for (const ClusterShare& share : clusters) {
    sum.part += share.part;
    sum.whole += share.whole;
    if (share.whole > 0) ++with_whole;
  }
  if (with_whole < 2) return kMissing;
  // Clusters that all agree do not tell how clusters differ: as in bootstrap_share.
  const auto all = [&](auto holds) { return std::ranges::all_of(clusters, holds); };
  if (all([](const ClusterShare& share) { return share.part == 0; }) ||
      all([](const ClusterShare& share) { return share.part == share.whole; }))
    return std::min(1.0, 3 / with_whole) / (2 * 1.96);
  double squares = 0;
  for (const ClusterShare& share : clusters) {
    const double residual = share.part - share.whole * sum.part / sum.whole;
    squares += residual * residual;
  }
  return std::sqrt(squares * with_whole / (with_whole - 1)) / sum.whole;
}

double relative_noise(std::span<const Repetition> repetitions, std::size_t places) {
  const std::vector<double> relative = residuals(repetitions, places).relative;
  return relative.empty() ? 0 : 0.5 * (quantile(relative, 0.75) - quantile(relative, 0.25));
}

double expanded_level(std::size_t n) {
  constexpr double kLevels[] = {0,       0,       0,       0,       0.000119, 0.000954, 0.00243,
                                0.00411, 0.00574, 0.00722, 0.00855, 0.00972,  0.0108,   0.0117,
                                0.0125,  0.0132,  0.0139,  0.0144,  0.0150,   0.0154};
  if (n < std::size(kLevels)) return kLevels[n];
  const auto count = static_cast<double>(n);
  return 0.025 - 0.19607 / count + 0.26047 / (count * count);  // to 0.0001 of the formula
}

}  // namespace vestige
