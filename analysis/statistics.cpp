#include "analysis/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace vestige {

namespace {

constexpr int kResamples = 1000;

std::vector<double> frequencies(std::span<const Repetition> repetitions) {
  std::vector<double> hz;
  for (const Repetition& repetition : repetitions) hz.push_back(frequency_hz({&repetition, 1}));
  return hz;
}

}  // namespace

double quantile(std::span<const double> values, double p) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::vector<double> sorted(values.begin(), values.end());
  std::ranges::sort(sorted);
  const double place = p * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (place - std::floor(place)) * (sorted[above] - sorted[below]);
}

double frequency_hz(std::span<const Repetition> repetitions) {
  double frames = 0;
  double seconds = 0;
  for (const Repetition& repetition : repetitions) {
    frames += static_cast<double>(repetition.frames);
    seconds += repetition.seconds;
  }
  return seconds > 0 ? frames / seconds : std::numeric_limits<double>::quiet_NaN();
}

Interval bootstrap_frequency_hz(std::span<const Repetition> repetitions, std::uint64_t seed) {
  if (repetitions.empty()) return {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
  std::mt19937_64 random(seed);
  std::vector<double> hz;
  std::vector<Repetition> sample(repetitions.size());
  for (int i = 0; i < kResamples; ++i) {
    for (Repetition& repetition : sample) repetition = repetitions[random() % repetitions.size()];
    hz.push_back(frequency_hz(sample));
  }
  return {quantile(hz, 0.025), quantile(hz, 0.975)};
}

double relative_noise(std::span<const Repetition> repetitions) {
  if (repetitions.size() < 2) return 0;
  const std::vector<double> hz = frequencies(repetitions);
  return 0.5 * (quantile(hz, 0.75) - quantile(hz, 0.25)) / quantile(hz, 0.5);
}

}  // namespace vestige
