#include "transport/latency_histogram.hpp"

#include <algorithm>
#include <cmath>

namespace vestige {

namespace {

constexpr double kClassWidth = 1.01;

}  // namespace

double LatencyHistogram::upper_end_us(std::size_t index) {
  return std::pow(kClassWidth, static_cast<double>(index));
}

void LatencyHistogram::add(double latency_s) {
  const double us = std::max(latency_s * 1e6, 0.0);
  const double place = us <= 1 ? 0 : std::ceil(std::log(us) / std::log(kClassWidth));
  ++counts_[static_cast<std::size_t>(std::min(place, static_cast<double>(kClasses - 1)))];
  ++count_;
  max_us_ = std::max(max_us_, us);
}

LatencyHistogram& LatencyHistogram::operator+=(const LatencyHistogram& other) {
  for (std::size_t i = 0; i < kClasses; ++i) counts_[i] += other.counts_[i];
  count_ += other.count_;
  max_us_ = std::max(max_us_, other.max_us_);
  return *this;
}

double LatencyHistogram::quantile_us(double share) const {
  if (count_ == 0) return 0;
  const auto rank = static_cast<std::uint64_t>(std::max(1.0, std::ceil(share * static_cast<double>(count_))));
  std::uint64_t seen = 0;
  for (std::size_t i = 0; i < kClasses; ++i) {
    seen += counts_[i];
    if (seen >= rank) return std::min(upper_end_us(i), max_us_);
  }
  return max_us_;
}

}  // namespace vestige
