#include "analysis/scoring/slide_score.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "analysis/base/statistics.hpp"

namespace vestige {

namespace {

constexpr double kLongestPause_s = 0.1;
constexpr double kLongestStep_m = 0.050;
constexpr double kShortestSlide_m = 0.050;
constexpr std::size_t kFewestContacts = 5;
constexpr double kRounding_m = 1e-9;  // of a felt place

}  // namespace

bool SlideFinder::breaks(std::uint32_t column, double time_s, const glm::dvec3& position_m) const {
  if (column >= chains_.size() || chains_[column].contacts == 0) return false;
  const Chain& chain = chains_[column];
  return time_s - chain.last_s > kLongestPause_s || glm::distance(chain.last_m, position_m) > kLongestStep_m;
}

SlideFinder::Step SlideFinder::add(std::uint32_t column, double time_s, const glm::dvec3& position_m) {
  if (column >= chains_.size()) chains_.resize(column + 1);
  const bool broken = breaks(column, time_s, position_m);
  Chain& chain = chains_[column];
  if (broken) chain = Chain();
  const bool begins = chain.contacts == 0;
  if (begins) chain.start_m = chain.last_m = position_m;
  chain.step_m = position_m - chain.last_m;
  chain.last_m = position_m;
  chain.last_s = time_s;
  chain.way_m += glm::length(chain.step_m);
  chain.reach_m = std::max(chain.reach_m, glm::distance(chain.start_m, position_m));
  ++chain.contacts;
  return begins ? Step::kBegins : Step::kGoesOn;
}

bool SlideFinder::is_slide(std::uint32_t column) const {
  if (column >= chains_.size()) return false;
  return chains_[column].reach_m >= kShortestSlide_m && chains_[column].contacts >= kFewestContacts;
}

void SlideSmoothness::add(double energy, const glm::dvec3* felt_at_m, const glm::dvec3& step_m) {
  ++contacts_;
  least_ = std::min(least_, energy);
  most_ = std::max(most_, energy);
  sum_ += energy;
  if (felt_at_m == nullptr) return;
  if (was_felt_) {
    const glm::dvec3 moved_m = *felt_at_m - felt_at_m_;
    largest_jump_m_ = std::max(largest_jump_m_, glm::length(moved_m));
    if (glm::dot(moved_m, moved_m) > kRounding_m * kRounding_m && glm::dot(moved_m, step_m) < 0) ++reversals_;
  }
  was_felt_ = true;
  felt_at_m_ = *felt_at_m;
}

double SlideSmoothness::ripple() const {
  return sum_ > 0 ? (most_ - least_) / (sum_ / static_cast<double>(contacts_)) : kMissing;
}

void SlideScore::add(const SlideSmoothness& slide, double way_m) {
  ++slides_;
  const double ripple = slide.ripple();
  if (std::isnan(ripple)) return;
  ++felt_;
  ripple_sum_ += ripple;
  jump_sum_m_ += slide.largest_jump_m();
  reversals_ += slide.reversals();
  way_m_ += way_m;
}

double SlideScore::ripple() const {
  return felt_ == 0 ? kMissing : ripple_sum_ / static_cast<double>(felt_);
}

double SlideScore::largest_jump_m() const {
  return felt_ == 0 ? kMissing : jump_sum_m_ / static_cast<double>(felt_);
}

double SlideScore::reversals_per_m() const {
  return felt_ == 0 ? kMissing : static_cast<double>(reversals_) / way_m_;
}

}  // namespace vestige
