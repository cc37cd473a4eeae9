#include <cmath>

#include "traces/places/random.hpp"
#include "traces/places/room.hpp"
#include "traces/scenarios/makers.hpp"
#include "traces/scenarios/scenarios.hpp"

namespace vestige {

namespace {

constexpr double kFall_m_per_s = 9;  // terminal speed of large drops
constexpr double kAbove_m = 0.3;     // above the room, so that a drop has fallen for a frame before it is tested
constexpr double kBelow_m = 0.3;

/// A drop falls at constant speed from above the room that the body takes up to below the room. Then it teleports to
/// above another place on the ground, as a new drop.
class Rain final : public ColliderSource {
 public:
  Rain(const Avatar& avatar, const Animation* animation, const ScenarioSettings& settings)
      : body_(avatar, animation), room_(body_), settings_(settings) {
    top_m_ = room_.high_m().y + kAbove_m * body_.metre();
    const double fall_m = top_m_ - room_.low_m().y + kBelow_m * body_.metre();
    fall_s_ = fall_m / (kFall_m_per_s * body_.metre());
    fall_m_ = fall_m;
    falls_.reserve(settings.count);
  }

  void sample(double time_s, std::vector<ColliderSample>& out) override {
    out.clear();
    teleported_.clear();
    const bool first = falls_.empty();
    falls_.resize(settings_.count);
    for (std::uint32_t id = 0; id < settings_.count; ++id) {
      const double falls = time_s / fall_s_ + Random(settings_.seed, id).uniform(0, 1);
      const auto fall = static_cast<std::uint64_t>(falls);
      if (!first && fall != falls_[id]) teleported_.push_back(id);
      falls_[id] = fall;
      const double share = falls - std::floor(falls);
      // The room's position is that in the middle of the fall.
      Random random(settings_.seed, id, fall + 1);
      const glm::dvec3 centre_m = room_.centre_m(time_s + (0.5 - share) * fall_s_);
      out.push_back({id, on_grid(centre_m + glm::dvec3(random.uniform(room_.low_m().x, room_.high_m().x),
                                                       top_m_ - share * fall_m_,
                                                       random.uniform(room_.low_m().z, room_.high_m().z)))});
    }
  }

 private:
  MovingBody body_;
  Room room_;
  ScenarioSettings settings_;
  double top_m_ = 0;   // relative to the room's centre
  double fall_m_ = 0;  // from top to bottom
  double fall_s_ = 0;
  std::vector<std::uint64_t> falls_;  // how many times each drop had fallen at the last sample
};

}  // namespace

std::unique_ptr<ColliderSource> make_rain(const Avatar& avatar, const Animation* animation,
                                          const ScenarioSettings& settings) {
  return std::make_unique<Rain>(avatar, animation, settings);
}

}  // namespace vestige
