#include "analysis/compare/pass_time.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "analysis/base/statistics.hpp"

namespace vestige {

namespace {

/// Other programs make a frame slower, so low quantiles tell more about the detector than the mean. The very lowest
/// tell less: a virtual machine may be faster for a moment.
constexpr double kTypical = 0.25;

struct Passes {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// Returns the sum over the frames of a pass of the p-quantile of each frame's durations, without these passes.
double pass_us(std::span<const double> frame_us, std::size_t pass_frames, double p, const Passes& without) {
  const std::size_t passes = frame_us.size() / pass_frames;
  double sum = 0;
  std::vector<double> durations;
  durations.reserve(passes);
  for (std::size_t i = 0; i < pass_frames; ++i) {
    durations.clear();
    for (std::size_t pass = 0; pass < passes; ++pass)
      if (pass < without.begin || pass >= without.end) durations.push_back(frame_us[pass * pass_frames + i]);
    sum += quantile(durations, p);
  }
  return sum;
}

/// Returns the jackknife's standard error of the logarithm of the typical pass.
double jackknife_error(std::span<const double> frame_us, std::size_t pass_frames, std::size_t batches) {
  const std::size_t passes = frame_us.size() / pass_frames;
  std::vector<double> without;
  without.reserve(batches);
  for (std::size_t batch = 0; batch < batches; ++batch) {
    const Passes left_out = {batch * passes / batches, (batch + 1) * passes / batches};
    without.push_back(std::log(pass_us(frame_us, pass_frames, kTypical, left_out)));
  }
  const auto n = static_cast<double>(batches);
  const double mean = std::accumulate(without.begin(), without.end(), 0.0) / n;
  double squares = 0;
  for (const double value : without) squares += (value - mean) * (value - mean);
  return std::sqrt((n - 1) / n * squares);
}

}  // namespace

PassTime pass_time(std::span<const double> frame_us, std::size_t pass_frames) {
  PassTime time;
  time.passes = frame_us.size() / pass_frames;
  time.us = pass_us(frame_us, pass_frames, kTypical, {});
  time.scatter = std::log(pass_us(frame_us, pass_frames, 0.5, {}) / time.us);
  time.batches = std::min(time.passes, kMostBatches);
  time.error = time.passes < kFewestPasses ? kMissing : jackknife_error(frame_us, pass_frames, time.batches);
  return time;
}

}  // namespace vestige
