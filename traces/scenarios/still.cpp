#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "traces/places/body.hpp"
#include "traces/places/random.hpp"
#include "traces/places/skin.hpp"
#include "traces/scenarios/makers.hpp"
#include "traces/scenarios/scenarios.hpp"

namespace vestige {

namespace {

constexpr std::size_t kInstants = 256;  // most poses that are examined
constexpr std::size_t kCandidates = 4;  // the one that moves farthest along its normal is taken
constexpr double kAround_s = 1.0 / 60;  // time before and after an instant in which the skin's motion is measured
constexpr double kSlowest_m = 1e-5;     // least motion in that time; less is not a sweep
constexpr double kBesideResting_m = 0.01;

/// A collider rests at a place where some point of the skin will be at some instant of the animation, so that the skin
/// sweeps over the collider. Beside an avatar that does not move, it rests 1 cm off the skin.
class Still final : public ColliderSource {
 public:
  Still(const Avatar& avatar, const Animation* animation, const ScenarioSettings& settings) {
    MovingBody body(avatar, animation);
    const Skin skin(avatar);
    const std::size_t instants = std::min<std::size_t>(settings.count, kInstants);
    resting_.resize(settings.count);
    for (std::size_t instant = 0; instant < instants; ++instant) {
      // Spread over the loop, without its first and last moments, because the skin may jump between them.
      Random when(settings.seed, instant);
      const double share = (static_cast<double>(instant) + when.uniform(0, 1)) / static_cast<double>(instants);
      const double around_s = std::min(kAround_s, 0.25 * body.loop_s());
      const double time_s = around_s + share * (body.loop_s() - 2 * around_s);
      const std::vector<glm::dmat4> before = body.palette(time_s - around_s);
      const std::vector<glm::dmat4> after = body.palette(time_s + around_s);
      const std::vector<glm::dmat4>& then = body.palette(time_s);
      for (std::size_t id = instant; id < resting_.size(); id += instants) {
        Random random(settings.seed, id, 1);
        double farthest_m = -1;
        for (std::size_t i = 0; i < kCandidates; ++i) {
          const SkinPoint point = skin.random_point(random);
          const SkinPlace place = skin.place(point, then);
          const glm::dvec3 way_m = skin.place(point, after).position_m - skin.place(point, before).position_m;
          const double swept_m = std::abs(glm::dot(way_m, skin.face_normal(point.triangle, then)));
          if (!(swept_m > farthest_m)) continue;
          farthest_m = swept_m;
          const double off_m = swept_m > kSlowest_m * body.metre() ? 0 : kBesideResting_m * body.metre();
          resting_[id] = on_grid(place.position_m + off_m * place.normal);
        }
        moves_ = moves_ || farthest_m > kSlowest_m * body.metre();
      }
    }
  }

  void sample(double, std::vector<ColliderSample>& out) override {
    out.clear();
    for (std::uint32_t id = 0; id < resting_.size(); ++id) out.push_back({id, resting_[id]});
  }

  std::vector<std::string> warnings() const override {
    if (moves_) return {};
    return {"the avatar does not move, so it touches no resting collider; record it with an animation"};
  }

 private:
  std::vector<glm::dvec3> resting_;
  bool moves_ = false;
};

}  // namespace

std::unique_ptr<ColliderSource> make_still(const Avatar& avatar, const Animation* animation,
                                           const ScenarioSettings& settings) {
  return std::make_unique<Still>(avatar, animation, settings);
}

}  // namespace vestige
