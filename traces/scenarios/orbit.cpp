#include <cmath>
#include <glm/common.hpp>
#include <numbers>

#include "traces/places/random.hpp"
#include "traces/places/room.hpp"
#include "traces/places/skin.hpp"
#include "traces/scenarios/makers.hpp"
#include "traces/scenarios/scenarios.hpp"

namespace vestige {

namespace {

constexpr double kShortestTurn_s = 0.8;  // once around
constexpr double kLongestTurn_s = 1.6;
constexpr double kWithin = 0.98;

/// Horizontal circles around the vertical axis through the body's centre, half of them in each direction. Each circle
/// goes through a random point of the skin at the beginning of the trace. That point gives the circle's radius and,
/// moved a little towards the middle, its height, because a circle must not graze a flat sole.
class Orbit final : public ColliderSource {
 public:
  Orbit(const Avatar& avatar, const Animation* animation, const ScenarioSettings& settings)
      : body_(avatar, animation), room_(body_) {
    const Skin skin(avatar);
    const std::vector<glm::dmat4>& palette = body_.palette(0);
    const glm::dvec3 centre_m = room_.centre_m(0);
    circles_.reserve(settings.count);
    for (std::uint32_t id = 0; id < settings.count; ++id) {
      Random random(settings.seed, id);
      const glm::dvec3 through_m = skin.place(skin.random_point(random), palette).position_m;
      const double y_m = centre_m.y + kWithin * (through_m.y - centre_m.y);
      const double turn_s = random.uniform(kShortestTurn_s, kLongestTurn_s);
      circles_.push_back({std::hypot(through_m.x - centre_m.x, through_m.z - centre_m.z), y_m, random.uniform(0, 1),
                          (random.next() % 2 == 0 ? 1 : -1) / turn_s});
    }
  }

  void sample(double time_s, std::vector<ColliderSample>& out) override {
    out.clear();
    teleported_.clear();
    const glm::dvec3 centre_m = room_.centre_m(time_s);
    const bool jumped = body_.jumps(time_s);
    for (std::uint32_t id = 0; id < circles_.size(); ++id) {
      const Circle& circle = circles_[id];
      const double angle = 2 * std::numbers::pi * (circle.phase + time_s * circle.turns_hz);
      const glm::dvec3 place_m(centre_m.x + circle.radius_m * std::cos(angle), circle.y_m,
                               centre_m.z + circle.radius_m * std::sin(angle));
      out.push_back({id, on_grid(place_m)});
      if (jumped) teleported_.push_back(id);
    }
  }

 private:
  struct Circle {
    double radius_m;
    double y_m;
    double phase;     // turns
    double turns_hz;  // negative: the other direction
  };

  MovingBody body_;
  Room room_;
  std::vector<Circle> circles_;
};

}  // namespace

std::unique_ptr<ColliderSource> make_orbit(const Avatar& avatar, const Animation* animation,
                                           const ScenarioSettings& settings) {
  return std::make_unique<Orbit>(avatar, animation, settings);
}

}  // namespace vestige
