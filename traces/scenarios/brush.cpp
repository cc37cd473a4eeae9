#include <cmath>
#include <glm/common.hpp>

#include "traces/places/arm.hpp"
#include "traces/places/body.hpp"
#include "traces/places/random.hpp"
#include "traces/scenarios/makers.hpp"
#include "traces/scenarios/scenarios.hpp"

namespace vestige {

namespace {

constexpr double kBrushRadius_m = 0.05;
constexpr double kBrushLift_m = 0.08;  // from the skin, on the way back
constexpr double kBrushDepth_m = 0.006;
constexpr double kBrushTurn_s = 2.4;
constexpr double kStroke = 0.65;  // shares of a turn: along the arm,
constexpr double kLift = 0.1;     // away from it,
constexpr double kBack = 0.15;    // back beside it; the rest: down again

/// A hand is a sphere that strokes an arm from the shoulder to the wrist, 6 mm deep, is lifted, and begins again. Every
/// second hand strokes the right arm. Hands follow each other at equal distances of time.
class Brush final : public ColliderSource {
 public:
  Brush(const Avatar& avatar, const Animation* animation, const ScenarioSettings& settings)
      : body_(avatar, animation),
        skin_(avatar),
        settings_(settings),
        phase_(Random(settings.seed).uniform(0, 1)),
        radius_m_(sphere_radius_m(body_, settings.radius_m, kBrushRadius_m)),
        arms_{outer_arm(skin_, ArmSide::kLeft), outer_arm(skin_, ArmSide::kRight)} {
    has_arms_ = !arms_[0].empty() && !arms_[1].empty();
    Random random(settings.seed);
    if (!has_arms_) arms_[0] = arms_[1] = {skin_.random_point(random)};
  }

  ColliderShape shape() const override { return radius_m_ > 0 ? ColliderShape::kSpheres : ColliderShape::kPoints; }

  void sample(double time_s, std::vector<ColliderSample>& out) override {
    out.clear();
    teleported_.clear();
    const bool jumped = body_.jumps(time_s);
    const std::vector<glm::dmat4>& palette = body_.palette(time_s);
    for (std::uint32_t id = 0; id < settings_.count; ++id) {
      const double turns = time_s / kBrushTurn_s + phase_ + static_cast<double>(id) / settings_.count;
      const double turn = turns - std::floor(turns);
      const double along = smooth(turn / kStroke) - smooth((turn - kStroke - kLift) / kBack);
      const double down = (1 - smooth((turn - kStroke) / kLift)) +
                          smooth((turn - kStroke - kLift - kBack) / (1 - kStroke - kLift - kBack));
      const SkinPlace place = place_along(skin_, arms_[id % 2], along, palette);
      const double up_m = static_cast<double>(radius_m_) + glm::mix(kBrushLift_m, -kBrushDepth_m, down) * body_.metre();
      out.push_back({id, on_grid(place.position_m + up_m * place.normal), radius_m_});
      if (jumped) teleported_.push_back(id);
    }
  }

  std::vector<std::string> warnings() const override {
    if (has_arms_) return {};
    return {"the avatar's bones do not name its arms, so the object stays over one spot of its skin"};
  }

 private:
  MovingBody body_;
  Skin skin_;
  ScenarioSettings settings_;
  double phase_;
  float radius_m_;
  std::vector<SkinPoint> arms_[2];
  bool has_arms_ = false;
};

}  // namespace

std::unique_ptr<ColliderSource> make_brush(const Avatar& avatar, const Animation* animation,
                                           const ScenarioSettings& settings) {
  return std::make_unique<Brush>(avatar, animation, settings);
}

}  // namespace vestige
