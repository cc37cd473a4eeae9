#include "analysis/scoring/timing_score.hpp"

#include <limits>

namespace vestige {

namespace {

constexpr std::array<double, 3> kNoticed_s = {0.015, 0.045, 0.050};
/// Frame times are rounded to nanoseconds.
constexpr double kTimeRounding_s = 1e-9;

double share(double part, std::uint64_t of) {
  return of == 0 ? std::numeric_limits<double>::quiet_NaN() : part / static_cast<double>(of);
}

}  // namespace

TimingScore::TimingScore(std::size_t actuator_count) : asked_(actuator_count) {}

void TimingScore::begins(std::size_t actuator, double time_s) {
  Asked& asked = asked_[actuator];
  asked.is_on = true;
  if (!asked.is_pending) return;
  asked.is_pending = false;
  const double late_s = time_s - asked.since_s;
  ++onsets_;
  onset_sum_s_ += late_s;
  for (std::size_t i = 0; i < kNoticed_s.size(); ++i)
    if (late_s > kNoticed_s[i] + kTimeRounding_s) ++late_[i];
}

void TimingScore::ends(std::size_t actuator, double time_s) {
  Asked& asked = asked_[actuator];
  asked.is_on = false;
  ++offsets_;
  offset_sum_s_ += time_s - asked.last_s;
}

double TimingScore::f1() const {
  return share(2 * static_cast<double>(right_pairs_), asked_pairs_ + on_pairs_);
}

double TimingScore::mean_onset_s() const {
  return share(onset_sum_s_, onsets_);
}

double TimingScore::mean_offset_s() const {
  return share(offset_sum_s_, offsets_);
}

double TimingScore::late_share(std::size_t limit) const {
  return share(static_cast<double>(late_[limit]), onsets_);
}

}  // namespace vestige
