#include "analysis/scoring/information.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "detector/actuators/portable_math.hpp"

namespace vestige {

namespace {

constexpr double kNoise_m = 0.0125;
constexpr double kHopeless = 25;  // farther ones would have under e^-12.5 of the nearest one's probability

/// Returns the probabilities of what the observer names for each actuator that fires alone. Each row adds up to 1.
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

/// Adds the counts of responses that feel the same up, in the first of their columns.
void merge_alike(const Firing& firing, std::size_t actuators, std::vector<double>& counts) {
  const std::vector<std::uint32_t> alike = firing.first_alike(actuators);
  for (std::size_t j = 0; j < actuators; ++j) {
    const std::size_t same = alike[j];
    if (same == j) continue;
    for (std::size_t row = 0; row < counts.size(); row += actuators + 1) {
      counts[row + same] += counts[row + j];
      counts[row + j] = 0;
    }
  }
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
        bits += count / all *
                (portable_log2(count) - portable_log2(of_row[i]) + portable_log2(all) -
                 portable_log2(of_column[j]));  // one by one: quotients of tiny counts overflow
  return std::max(bits, 0.0);                   // negative only by rounding
}

RegionObserver::RegionObserver(std::size_t actuator_count)
    : actuators_(actuator_count),
      single_(actuator_count * actuator_count, 0),
      named_(actuator_count * (actuator_count + 1), 0) {}

void RegionObserver::add(std::size_t region, const ActuatorLayout& layout, const LocatedContact& contact,
                         const glm::dvec2& offset_m) {
  ++contacts_;
  const auto away_squared = [&](std::size_t actuator) {
    const glm::dvec2 away = layout.towards_m(contact, actuator) - offset_m;
    return glm::dot(away, away);
  };
  // Only actuators that are not hopelessly farther away than the region's own actuator can be named.
  const double reach_squared = away_squared(region) + kHopeless * kNoise_m * kNoise_m;
  const double reach_m = std::sqrt(reach_squared) + glm::length(offset_m);
  const std::span<const float> distance_m = contact.distance_m();
  likely_.clear();
  double least = reach_squared;
  for (std::uint32_t i = 0; i < distance_m.size(); ++i) {
    if (static_cast<double>(distance_m[i]) > reach_m) continue;
    const double squared = away_squared(i);
    if (squared > reach_squared) continue;
    likely_.push_back({i, squared});
    least = std::min(least, squared);
  }
  double sum = 0;
  for (Share& likely : likely_) {
    const double excess = likely.amplitude - least;
    likely.amplitude = excess == 0 ? 1 : portable_exp(-0.5 * excess / (kNoise_m * kNoise_m));
    sum += likely.amplitude;
  }
  double* const row = named_.data() + region * (actuators_ + 1);
  for (const Share& likely : likely_) row[likely.actuator] += likely.amplitude / sum;
}

double RegionObserver::bits(const ActuatorLayout& layout) const {
  if (contacts_ == 0) return std::numeric_limits<double>::quiet_NaN();
  const std::size_t columns = actuators_ + 1;
  const std::vector<double> named = confusions(layout);
  std::vector<double> counts = named_;
  for (std::size_t region = 0; region < actuators_; ++region) {
    for (std::size_t i = 0; i < actuators_; ++i) {
      const double felt = single_[region * actuators_ + i];
      if (felt == 0) continue;
      for (std::size_t j = 0; j < actuators_; ++j) counts[region * columns + j] += felt * named[i * actuators_ + j];
    }
  }
  merge_alike(layout.map().firing, actuators_, counts);
  return transmitted_bits(counts, columns);
}

}  // namespace vestige
