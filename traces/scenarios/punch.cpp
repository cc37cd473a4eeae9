#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "traces/places/body.hpp"
#include "traces/places/front_view.hpp"
#include "traces/places/random.hpp"
#include "traces/scenarios/makers.hpp"
#include "traces/scenarios/scenarios.hpp"
#include "traces/scene/pose.hpp"
#include "traces/scene/reference_skinning.hpp"

namespace vestige {

namespace {

constexpr std::uint32_t kFistPoints = 8;
constexpr double kFistRadius_m = 0.035;
constexpr double kStrike_m_per_s = 8;  // speed at the skin
constexpr double kDepth_m = 0.04;
constexpr double kReach_m = 0.4;  // from rest to the skin, accelerating all the way
constexpr double kStop_s = 2 * kDepth_m / kStrike_m_per_s;
constexpr double kSwing_s = 2 * kReach_m / kStrike_m_per_s;
constexpr double kBack_s = 0.25;
constexpr double kShortestRound_s = 0.7;  // from one strike to the next
constexpr double kLongestRound_s = 1.1;

constexpr double kLowest = 0.5;  // fractions of the height at rest: hips to head
constexpr double kHighest = 0.97;
constexpr double kHalfWidth_m = 0.2;
constexpr double kFacing = 0.6;  // least cosine between the normal of the struck skin and the front
constexpr double kSpread = 0.2;  // largest deviation of a strike from the normal, as a tangent

/// Place, direction and time of a fist's strike on the skin.
struct Strike {
  double time_s = 0;
  glm::dvec3 target_m = glm::dvec3(0);
  glm::dvec3 inwards = glm::dvec3(0, 0, -1);
};

/// A fist is a disc of points. It accelerates to 8 m/s at the skin, decelerates evenly within 4 cm, draws back and
/// moves to the beginning of its next strike. It strikes against the skin's normal, at the place where the skin is at
/// the moment of the strike.
class Punch final : public ColliderSource {
 public:
  Punch(const Avatar& avatar, const Animation* animation, const ScenarioSettings& settings)
      : body_(avatar, animation), skin_(avatar), settings_(settings) {
    find_targets();
    const std::uint32_t fists = (settings.count + kFistPoints - 1) / kFistPoints;
    fists_.reserve(fists);
    for (std::uint32_t number = 0; number < fists; ++number) {
      Random random(settings.seed, number);
      Fist fist;
      fist.period_s = random.uniform(kShortestRound_s, kLongestRound_s);
      fist.phase = random.uniform(0, 1);
      fists_.push_back(fist);
    }
  }

  void sample(double time_s, std::vector<ColliderSample>& out) override {
    out.clear();
    for (std::uint32_t id = 0; id < settings_.count; ++id) {
      Fist& fist = fists_[id / kFistPoints];
      if (id % kFistPoints == 0) follow(fist, id / kFistPoints, time_s);
      const glm::dvec2 place = kFistRadius_m * disc_place(id % kFistPoints, kFistPoints);
      out.push_back({id, on_grid(position_m(fist, place, time_s))});
    }
  }

 private:
  struct Fist {
    double period_s = 1;
    double phase = 0;
    double turn = -9;  // number of the last strike; the first of all is -1 or 0
    Strike last;
    Strike next;
  };

  /// Finds the places at which the front of torso and head faces the fists, at rest.
  void find_targets() {
    const FrontView view(skin_);
    if (!(view.cell_m() > 0)) return;
    std::vector<glm::dmat4> rest;
    palette_matrices(skin_.avatar(), rest_pose(skin_.avatar()), rest);
    const double middle_m = 0.5 * (view.box_m().low.x + view.box_m().high.x);
    const double half_m = kHalfWidth_m * body_.metre();
    const int last_row = view.row_of(glm::mix(view.box_m().low.y, view.box_m().high.y, kHighest));
    const int last_column = view.column_of(middle_m + half_m);
    for (int row = view.row_of(glm::mix(view.box_m().low.y, view.box_m().high.y, kLowest)); row <= last_row; ++row) {
      for (int column = view.column_of(middle_m - half_m); column <= last_column; ++column) {
        const FrontView::Cell* cell = view.at(column, row);
        if (cell == nullptr) continue;
        const glm::dvec3 normal = skin_.place(cell->point, rest).normal;
        if (turned_to_front(normal, skin_.avatar().facing.axis).z > kFacing) targets_.push_back(cell->point);
      }
    }
  }

  Strike strike(const Fist& fist, std::uint32_t number, double turn) {
    Random random(settings_.seed, number, static_cast<std::uint64_t>(turn + 2));
    const SkinPoint target = targets_.empty() ? skin_.random_point(random) : targets_[random.index(targets_.size())];
    const double time_s = (turn + fist.phase) * fist.period_s;
    const SkinPlace place = skin_.place(target, body_.palette(time_s));
    return {time_s, place.position_m, glm::normalize(kSpread * random.direction() - place.normal)};
  }

  /// Updates the fist's strikes around `time_s`.
  void follow(Fist& fist, std::uint32_t number, double time_s) {
    const double turn = std::floor(time_s / fist.period_s - fist.phase);
    if (turn == fist.turn) return;
    fist.last = turn == fist.turn + 1 ? fist.next : strike(fist, number, turn);
    fist.next = strike(fist, number, turn + 1);
    fist.turn = turn;
  }

  /// Returns a point of the fist when its middle is `depth_m` below the skin that the strike meets.
  glm::dvec3 point_m(const Strike& strike, const glm::dvec2& place, double depth_m) const {
    const Across sideways = across(strike.inwards);
    return strike.target_m +
           body_.metre() * (place.x * sideways.first + place.y * sideways.second + depth_m * strike.inwards);
  }

  glm::dvec3 position_m(const Fist& fist, const glm::dvec2& place, double time_s) const {
    const double since_s = time_s - fist.last.time_s;
    const double until_s = fist.next.time_s - time_s;
    if (since_s < kStop_s) {
      const double braking = kStrike_m_per_s / kStop_s;
      return point_m(fist.last, place, since_s * (kStrike_m_per_s - 0.5 * braking * since_s));
    }
    if (since_s < kStop_s + kBack_s)
      return point_m(fist.last, place, glm::mix(kDepth_m, -kReach_m, smooth((since_s - kStop_s) / kBack_s)));
    if (until_s < kSwing_s) {
      const double swung_s = kSwing_s - until_s;
      return point_m(fist.next, place, 0.5 * kStrike_m_per_s / kSwing_s * swung_s * swung_s - kReach_m);
    }
    const double idle_s = fist.period_s - kStop_s - kBack_s - kSwing_s;
    return glm::mix(point_m(fist.last, place, -kReach_m), point_m(fist.next, place, -kReach_m),
                    smooth((since_s - kStop_s - kBack_s) / idle_s));
  }

  MovingBody body_;
  Skin skin_;
  ScenarioSettings settings_;
  std::vector<SkinPoint> targets_;
  std::vector<Fist> fists_;
};

}  // namespace

std::unique_ptr<ColliderSource> make_punch(const Avatar& avatar, const Animation* animation,
                                           const ScenarioSettings& settings) {
  return std::make_unique<Punch>(avatar, animation, settings);
}

}  // namespace vestige
