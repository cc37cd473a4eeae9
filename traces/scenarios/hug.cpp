#include <cmath>
#include <numbers>

#include "traces/places/body.hpp"
#include "traces/places/random.hpp"
#include "traces/places/skin_walk.hpp"
#include "traces/scenarios/makers.hpp"
#include "traces/scenarios/scenarios.hpp"

namespace vestige {

namespace {

constexpr double kWander_m_per_s = 0.3;  // along the skin
constexpr double kStraight_m = 0.05;
constexpr double kLeastReach_m = 0.008;  // to each side of the skin
constexpr double kMostReach_m = 0.018;
constexpr double kLeast_hz = 3;  // cycles of in and out
constexpr double kMost_hz = 6;

/// A collider oscillates about a point of the posed skin that walks along the skin. A collider is never farther from
/// the skin than its reach, however the skin moves.
class Hug final : public ColliderSource {
 public:
  Hug(const Avatar& avatar, const Animation* animation, const ScenarioSettings& settings)
      : body_(avatar, animation),
        skin_(avatar),
        walk_(skin_, kWander_m_per_s * body_.metre(), kStraight_m * body_.metre()) {
    walkers_.reserve(settings.count);
    for (std::uint32_t id = 0; id < settings.count; ++id) {
      Random random(settings.seed, id);
      const SkinStep step = walk_.begin(0, random);
      const double reach_m = random.uniform(kLeastReach_m, kMostReach_m) * body_.metre();
      const double swings_hz = random.uniform(kLeast_hz, kMost_hz);
      const double phase = random.uniform(0, 1);
      walkers_.push_back({random, step, reach_m, swings_hz, phase});
    }
  }

  void sample(double time_s, std::vector<ColliderSample>& out) override {
    out.clear();
    teleported_.clear();
    const bool jumped = body_.jumps(time_s);
    const std::vector<glm::dmat4>& palette = body_.palette(time_s);
    for (std::uint32_t id = 0; id < walkers_.size(); ++id) {
      Walker& walker = walkers_[id];
      while (walker.step.end_s <= time_s) walker.step = walk_.next(walker.step, walker.random);
      const SkinPlace place = skin_.place(walker.step.at(time_s), palette);
      const double swing = std::sin(2 * std::numbers::pi * (walker.phase + time_s * walker.swings_hz));
      out.push_back({id, on_grid(place.position_m + walker.reach_m * swing * place.normal)});
      if (jumped) teleported_.push_back(id);
    }
  }

 private:
  struct Walker {
    Random random;
    SkinStep step;
    double reach_m;
    double swings_hz;
    double phase;
  };

  MovingBody body_;
  Skin skin_;
  SkinWalk walk_;
  std::vector<Walker> walkers_;
};

}  // namespace

std::unique_ptr<ColliderSource> make_hug(const Avatar& avatar, const Animation* animation,
                                         const ScenarioSettings& settings) {
  return std::make_unique<Hug>(avatar, animation, settings);
}

}  // namespace vestige
