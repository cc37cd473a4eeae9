#include "analysis/mapping/information.hpp"

#include <limits>

#include "detector/portable_math.hpp"

namespace vestige {

namespace {

constexpr double kNoise_m = 0.0125;

/// What the observer names for each actuator that it attends to: rows add up to 1.
std::vector<double> confusions(const ActuatorLayout& layout) {
  const std::size_t n = layout.actuator_count();
  std::vector<double> named(n * n, 0);
  for (std::size_t i = 0; i < n; ++i) {
    double sum = 0;
    for (std::size_t j = 0; j < n; ++j) {
      const double away = layout.between_m(i, j) / kNoise_m;
      named[i * n + j] = i == j ? 1 : portable_exp(-0.5 * away * away);
      sum += named[i * n + j];
    }
    for (std::size_t j = 0; j < n; ++j) named[i * n + j] /= sum;
  }
  return named;
}

}  // namespace

double transmitted_bits(std::span<const double> counts, std::size_t columns) {
  const std::size_t rows = columns == 0 ? 0 : counts.size() / columns;
  std::vector<double> of_row(rows, 0);
  std::vector<double> of_column(columns, 0);
  double all = 0;
  for (std::size_t i = 0; i < rows; ++i) {
    for (std::size_t j = 0; j < columns; ++j) {
      of_row[i] += counts[i * columns + j];
      of_column[j] += counts[i * columns + j];
    }
    all += of_row[i];
  }
  double bits = 0;
  for (std::size_t i = 0; i < rows; ++i)
    for (std::size_t j = 0; j < columns; ++j)
      if (const double count = counts[i * columns + j]; count > 0)
        bits += count / all * portable_log2(count / of_row[i] * (all / of_column[j]));
  return bits;
}

RegionObserver::RegionObserver(std::size_t actuator_count)
    : actuators_(actuator_count), attended_(actuator_count * (actuator_count + 1), 0) {}

void RegionObserver::add(std::size_t region, std::span<const Share> shares) {
  ++contacts_;
  double* const row = attended_.data() + region * (actuators_ + 1);
  double energy = 0;
  for (const Share& share : shares) energy += share.amplitude * share.amplitude;
  if (!(energy > 0)) {
    row[actuators_] += 1;
    return;
  }
  for (const Share& share : shares) row[share.actuator] += share.amplitude * share.amplitude / energy;
}

double RegionObserver::bits(const ActuatorLayout& layout) const {
  if (contacts_ == 0) return std::numeric_limits<double>::quiet_NaN();
  const std::size_t columns = actuators_ + 1;
  const std::vector<double> named = confusions(layout);
  std::vector<double> counts(attended_.size(), 0);
  for (std::size_t region = 0; region < actuators_; ++region) {
    for (std::size_t i = 0; i < actuators_; ++i) {
      const double attended = attended_[region * columns + i];
      if (attended == 0) continue;
      for (std::size_t j = 0; j < actuators_; ++j) counts[region * columns + j] += attended * named[i * actuators_ + j];
    }
    counts[region * columns + actuators_] = attended_[region * columns + actuators_];
  }
  return transmitted_bits(counts, columns);
}

}  // namespace vestige
