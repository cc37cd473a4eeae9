#include "detector/actuators/held_amplitudes.hpp"

#include <algorithm>
#include <limits>

namespace vestige {

HeldAmplitudes::HeldAmplitudes(std::size_t actuator_count, double hold_s, Rule rule)
    : rule_(rule),
      hold_s_(hold_s),
      amplitude_(actuator_count, 0),
      until_s_(actuator_count, std::numeric_limits<double>::infinity()),
      weaker_(rule == Rule::kEveryContact ? actuator_count : 0) {}

void HeldAmplitudes::begin(double time_s) {
  time_s_ = time_s;
  if (rule_ == Rule::kLatestOfCollider) {
    std::erase_if(live_, [&](std::uint32_t column) {
      Collider& collider = colliders_[column];
      collider.is_live = time_s < collider.until_s;
      return !collider.is_live;
    });
    return;
  }
  for (std::size_t i = 0; i < until_s_.size(); ++i) {
    if (time_s < until_s_[i]) continue;
    std::vector<Held>& weaker = weaker_[i];
    const auto next = std::ranges::find_if(weaker, [&](const Held& held) { return time_s < held.until_s; });
    const bool any = next != weaker.end();
    amplitude_[i] = any ? next->amplitude : 0;
    until_s_[i] = any ? next->until_s : std::numeric_limits<double>::infinity();
    weaker.erase(weaker.begin(), any ? next + 1 : next);
  }
}

void HeldAmplitudes::add(std::uint32_t column, std::span<const Share> shares) {
  if (shares.empty()) return;
  const double until_s = time_s_ + hold_s_;
  if (rule_ == Rule::kLatestOfCollider) {
    if (column >= colliders_.size()) colliders_.resize(column + 1);
    Collider& collider = colliders_[column];
    collider.until_s = until_s;
    collider.shares.assign(shares.begin(), shares.end());
    if (!collider.is_live) live_.push_back(column);
    collider.is_live = true;
    return;
  }
  for (const Share& share : shares) {
    const std::size_t i = share.actuator;
    std::vector<Held>& weaker = weaker_[i];
    if (share.amplitude >= amplitude_[i]) {
      amplitude_[i] = share.amplitude;
      until_s_[i] = until_s;
      weaker.clear();
    } else {
      while (!weaker.empty() && weaker.back().amplitude <= share.amplitude) weaker.pop_back();
      weaker.push_back({until_s, share.amplitude});
    }
  }
}

const std::vector<double>& HeldAmplitudes::now() {
  if (rule_ == Rule::kLatestOfCollider) {
    std::ranges::fill(amplitude_, 0.0);
    for (const std::uint32_t column : live_)
      for (const Share& share : colliders_[column].shares)
        amplitude_[share.actuator] = std::max(amplitude_[share.actuator], share.amplitude);
  }
  return amplitude_;
}

}  // namespace vestige
