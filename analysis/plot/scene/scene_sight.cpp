#include "analysis/plot/scene/scene_sight.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

namespace vestige::plot {

namespace {

/// Room for colliders around the body, in heights of it.
constexpr double kRoom = 0.13;

/// What stays in place in the picture.
glm::dvec3 still_of(const SceneSight& sight, const Surface& surface) {
  if (!sight.follows) return sight.middle_m;
  const glm::dvec3 own = (surface.low + surface.high) / 2.0;
  return {own.x, sight.middle_m.y, own.z};
}

}  // namespace

View SceneSight::view_of(const Surface& surface, std::size_t width_dots, std::size_t height_dots,
                         double m_per_dot) const {
  View view;
  view.camera = camera;
  view.width = width_dots;
  view.height = height_dots;
  view.unit_per_dot = m_per_dot;
  const glm::dvec3 still = camera.seen(still_of(*this, surface));
  view.left = still.x + low_m.x - (static_cast<double>(width_dots) * m_per_dot - size_m.x) / 2;
  view.bottom = still.y + low_m.y;
  return view;
}

void SightFinder::Seen::add(const glm::dvec2& point) {
  if (!std::isfinite(point.x + point.y)) return;
  low = glm::min(low, point);
  high = glm::max(high, point);
}

SightFinder::SightFinder(const Camera& camera) : camera_(camera) {}

void SightFinder::add(const Surface& surface) {
  low_ = glm::min(low_, surface.low);
  high_ = glm::max(high_, surface.high);
  largest_ = glm::max(largest_, surface.high - surface.low);
  const glm::dvec3 own = (surface.low + surface.high) / 2.0;
  const glm::dvec2 below(camera_.seen({own.x, 0, own.z}));
  for (const glm::uvec3& triangle : surface.triangles) {
    for (int corner = 0; corner < 3; ++corner) {
      const glm::dvec2 seen(camera_.seen(glm::dvec3(surface.position[triangle[corner]])));
      standing_.add(seen);
      following_.add(seen - below);
    }
  }
}

SceneSight SightFinder::sight() const {
  SceneSight sight;
  sight.camera = camera_;
  sight.ground_y_m = low_.y;
  sight.extent_m = std::max({largest_.x, largest_.y, largest_.z});
  if (!(sight.extent_m > 0)) sight.extent_m = 1;
  const glm::dvec3 all = high_ - low_;
  sight.follows = std::max(all.x, all.z) > 1.5 * std::max(largest_.x, largest_.z) + 0.5 * sight.extent_m;
  sight.middle_m = (low_ + high_) / 2.0;
  const glm::dvec3 still = sight.follows ? glm::dvec3(0, sight.middle_m.y, 0) : sight.middle_m;
  const Seen& seen = sight.follows ? following_ : standing_;
  const double room = kRoom * sight.extent_m;
  sight.low_m = seen.low - glm::dvec2(camera_.seen(still)) - room;
  sight.size_m = glm::max(seen.high - seen.low + 2 * room, glm::dvec2(2 * room));
  return sight;
}

}  // namespace vestige::plot
