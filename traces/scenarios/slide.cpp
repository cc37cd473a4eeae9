#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <map>
#include <numbers>

#include "traces/places/body.hpp"
#include "traces/places/front_view.hpp"
#include "traces/places/random.hpp"
#include "traces/scenarios/makers.hpp"
#include "traces/scenarios/scenarios.hpp"

namespace vestige {

namespace {

constexpr double kChest = 0.72;      // fraction of the height at rest
constexpr double kHalfWay_m = 0.14;  // longest path to each side
constexpr double kSteepest = 3;      // a steeper slope ends the chest: an arm or the side begins there
constexpr double kThereAndBack_s = 2;
constexpr double kObjectRadius_m = 0.025;
constexpr double kDip_m = 0.004;
constexpr double kDips_hz = 20;

/// The object is a round patch of points. Its middle moves from the avatar's left to its right and back at constant
/// speed. Each point follows the skin at its own height, and dips through the skin all the way. The path moves with the
/// avatar.
class Slide final : public ColliderSource {
 public:
  Slide(const Avatar& avatar, const Animation* animation, const ScenarioSettings& settings)
      : body_(avatar, animation), skin_(avatar), view_(skin_), phase_(Random(settings.seed).uniform(0, 1)) {
    find_chest();
    if (tracks_.empty()) {
      Random random(settings.seed);
      tracks_[0].cells = {skin_.random_point(random)};
    }
    points_.reserve(settings.count);
    for (std::uint32_t id = 0; id < settings.count; ++id) {
      const glm::dvec2 place = kObjectRadius_m * body_.metre() * disc_place(id, settings.count);
      const int row = row_ + (view_.cell_m() > 0 ? static_cast<int>(std::round(place.y / view_.cell_m())) : 0);
      // Every row's track is computed at most once. Without a track, the point stays level with the middle.
      if (!tracks_.contains(row)) {
        const Track track = track_at(row);
        tracks_[row] = track.cells.empty() ? tracks_.at(row_) : track;
      }
      points_.push_back({place.x, &tracks_.at(row)});
    }
  }

  void sample(double time_s, std::vector<ColliderSample>& out) override {
    out.clear();
    teleported_.clear();
    const bool jumped = body_.jumps(time_s);
    const std::vector<glm::dmat4>& palette = body_.palette(time_s);
    const double turns = time_s / kThereAndBack_s;
    // 1 at the avatar's left, -1 at its right.
    const double side = std::abs(4 * (turns - std::floor(turns)) - 2) - 1;
    const double x_m = from_x_m_ + 0.5 * (side + 1) * (to_x_m_ - from_x_m_);
    const double dip_m = kDip_m * body_.metre() * std::sin(2 * std::numbers::pi * (phase_ + time_s * kDips_hz));
    for (std::uint32_t id = 0; id < points_.size(); ++id) {
      const SkinPlace place = along(points_[id], x_m, palette);
      out.push_back({id, on_grid(place.position_m + dip_m * place.normal)});
      if (jumped) teleported_.push_back(id);
    }
  }

  std::vector<std::string> warnings() const override {
    if (has_chest_) return {};
    return {"seen from its front the avatar has no chest, so the object stays on one spot of its skin"};
  }

 private:
  /// The adjacent cells of one row of the view.
  struct Track {
    std::vector<SkinPoint> cells;
    double first_x_m = 0;
  };
  struct Point {
    double ahead_m;  // distance ahead of the object's middle, towards the avatar's left
    const Track* track;
  };

  double middle_x_m() const { return 0.5 * (view_.box_m().low.x + view_.box_m().high.x); }

  /// Finds the chest's height, or the nearest height at which there is skin in the middle.
  void find_chest() {
    if (!(view_.cell_m() > 0)) return;
    const int chest = view_.row_of(glm::mix(view_.box_m().low.y, view_.box_m().high.y, kChest));
    for (int away = 0; away < view_.rows(); ++away) {
      for (const int row : {chest - away, chest + away}) {
        const Track track = track_at(row);
        if (track.cells.empty()) continue;
        row_ = row;
        has_chest_ = true;
        from_x_m_ = track.first_x_m;
        to_x_m_ = from_x_m_ + view_.cell_m() * static_cast<double>(track.cells.size() - 1);
        tracks_[row] = track;
        return;
      }
    }
  }

  /// Returns the track from the middle to both sides, as far as the skin continues.
  Track track_at(int row) const {
    const int middle = view_.column_of(middle_x_m());
    if (view_.at(middle, row) == nullptr) return {};
    const int farthest = std::max(1, static_cast<int>(kHalfWay_m * body_.metre() / view_.cell_m()));
    const auto end = [&](int step) {
      int column = middle;
      while (std::abs(column + step - middle) <= farthest) {
        const FrontView::Cell* next = view_.at(column + step, row);
        if (next == nullptr || std::abs(next->z_m - view_.at(column, row)->z_m) > kSteepest * view_.cell_m()) break;
        column += step;
      }
      return column;
    };
    const int first = end(-1);
    Track track{{}, view_.box_m().low.x + (first + 0.5) * view_.cell_m()};
    for (int column = first; column <= end(1); ++column) track.cells.push_back(view_.at(column, row)->point);
    return track;
  }

  SkinPlace along(const Point& point, double x_m, const std::vector<glm::dmat4>& palette) const {
    const Track& track = *point.track;
    if (track.cells.size() == 1) return skin_.place(track.cells.front(), palette);
    const double last = static_cast<double>(track.cells.size() - 1);
    const double place = std::clamp((x_m + point.ahead_m - track.first_x_m) / view_.cell_m(), 0.0, last);
    const double before = std::min(std::floor(place), last - 1);
    const auto index = static_cast<std::size_t>(before);
    const SkinPlace here = skin_.place(track.cells[index], palette);
    const SkinPlace next = skin_.place(track.cells[index + 1], palette);
    return {glm::mix(here.position_m, next.position_m, place - before),
            glm::mix(here.normal, next.normal, place - before)};
  }

  MovingBody body_;
  Skin skin_;
  FrontView view_;
  double phase_;
  int row_ = 0;
  bool has_chest_ = false;
  std::map<int, Track> tracks_;  // by row
  double from_x_m_ = 0;          // path of the middle, at rest
  double to_x_m_ = 0;
  std::vector<Point> points_;
};

}  // namespace

std::unique_ptr<ColliderSource> make_slide(const Avatar& avatar, const Animation* animation,
                                           const ScenarioSettings& settings) {
  return std::make_unique<Slide>(avatar, animation, settings);
}

}  // namespace vestige
