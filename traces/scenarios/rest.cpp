#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "traces/places/arm.hpp"
#include "traces/places/body.hpp"
#include "traces/places/random.hpp"
#include "traces/scenarios/makers.hpp"
#include "traces/scenarios/scenarios.hpp"

namespace vestige {

namespace {

constexpr double kRestRadius_m = 0.05;
constexpr double kAway_m = 0.15;  // from the skin, before and after
constexpr double kLeastDepth_m = 0.005;
constexpr double kMostDepth_m = 0.007;
constexpr double kWay_s = 0.3;  // to the skin, and away from it
constexpr double kShortestRest_s = 1.4;
constexpr double kLongestRest_s = 2.0;
constexpr double kNoTurn = -1;
constexpr double kLaid = 0.6;  // share of a turn between coming and leaving

/// A hand is a sphere that is laid on the skin, 5 to 7 mm deep, stays there however the body moves, and is lifted
/// again. The first hand is always laid on the left shoulder. The others are laid anywhere, elsewhere in each turn;
/// they jump there while they are away.
class Rest final : public ColliderSource {
 public:
  Rest(const Avatar& avatar, const Animation* animation, const ScenarioSettings& settings)
      : body_(avatar, animation),
        skin_(avatar),
        settings_(settings),
        radius_m_(sphere_radius_m(body_, settings.radius_m, kRestRadius_m)) {
    const std::vector<SkinPoint> arm = outer_arm(skin_, ArmSide::kLeft);
    has_arm_ = !arm.empty();
    hands_.reserve(settings.count);
    for (std::uint32_t id = 0; id < settings.count; ++id) {
      Random random(settings.seed, id);
      const double turn_s = random.uniform(kShortestRest_s, kLongestRest_s);
      const double depth_m = random.uniform(kLeastDepth_m, kMostDepth_m);
      const bool on_shoulder = id == 0 && has_arm_;
      hands_.push_back({turn_s, depth_m, on_shoulder ? 0 : random.uniform(0, 1), kNoTurn, on_shoulder,
                        on_shoulder ? arm.front() : SkinPoint()});
    }
  }

  ColliderShape shape() const override { return radius_m_ > 0 ? ColliderShape::kSpheres : ColliderShape::kPoints; }

  void sample(double time_s, std::vector<ColliderSample>& out) override {
    out.clear();
    teleported_.clear();
    const bool jumped = body_.jumps(time_s);
    for (std::uint32_t id = 0; id < hands_.size(); ++id) {
      Hand& hand = hands_[id];
      const double turns = time_s / hand.turn_s + hand.phase;
      const bool moves_on = std::floor(turns) != hand.turn;
      const bool jumps = moves_on && hand.turn != kNoTurn && !hand.on_shoulder;
      if (moves_on) begin_turn(hand, id, std::floor(turns));
      const SkinPlace place = skin_.place(hand.target, body_.palette(time_s));
      const double away_m = height_m(hand, (turns - hand.turn) * hand.turn_s) * body_.metre();
      const double up_m = static_cast<double>(radius_m_) + away_m;
      out.push_back({id, on_grid(place.position_m + up_m * place.normal), radius_m_});
      if (jumped || jumps) teleported_.push_back(id);
    }
  }

  std::vector<std::string> warnings() const override {
    if (has_arm_) return {};
    return {"the avatar's bones do not name its left arm, so the first hand is laid anywhere, as the others are"};
  }

 private:
  struct Hand {
    double turn_s;
    double depth_m;
    double phase;
    double turn;  ///< the number of the current turn, from 0
    bool on_shoulder;
    SkinPoint target;
  };

  void begin_turn(Hand& hand, std::uint32_t id, double turn) const {
    hand.turn = turn;
    if (hand.on_shoulder) return;
    Random random(settings_.seed, id, static_cast<std::uint64_t>(turn) + 1);
    hand.target = skin_.random_point(random);
  }

  /// Returns how far the hand's surface is above the skin, so long after the beginning of a turn.
  static double height_m(const Hand& hand, double since_s) {
    const double arrives_s = 0.5 * (1 - kLaid) * hand.turn_s;
    const double leaves_s = hand.turn_s - arrives_s;
    const double laid = smooth((since_s - arrives_s + kWay_s) / kWay_s) - smooth((since_s - leaves_s) / kWay_s);
    return glm::mix(kAway_m, -hand.depth_m, laid);
  }

  MovingBody body_;
  Skin skin_;
  ScenarioSettings settings_;
  float radius_m_;
  bool has_arm_ = false;
  std::vector<Hand> hands_;
};

}  // namespace

std::unique_ptr<ColliderSource> make_rest(const Avatar& avatar, const Animation* animation,
                                          const ScenarioSettings& settings) {
  return std::make_unique<Rest>(avatar, animation, settings);
}

}  // namespace vestige
