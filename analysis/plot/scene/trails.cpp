#include "analysis/plot/scene/trails.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <utility>

namespace vestige::plot {

namespace {

/// The most stops of a path, at any frame rate: about as many as a page can show.
constexpr double kMostStops = 400;

}  // namespace

void Trails::add(const TraceFrame& frame) {
  const double time_s = frame.time_s();
  for (auto& [id, trail] : trails_) trail.is_current = false;
  for (const std::uint32_t id : frame.teleported) finish(id);
  for (const ColliderSample& collider : frame.colliders) {
    const glm::dvec3& at = collider.position_m;
    if (!std::isfinite(at.x) || !std::isfinite(at.y) || !std::isfinite(at.z)) continue;
    Path& trail = trails_[collider.id];
    trail.collider = collider.id;
    trail.is_current = true;
    trail.radius_m = collider.radius_m;
    thin(trail);
    trail.stops.push_back({time_s, at});
  }
  std::vector<std::uint32_t> gone;
  for (const auto& [id, trail] : trails_)
    if (!trail.is_current) gone.push_back(id);
  for (const std::uint32_t id : gone) finish(id);
  for (auto& [id, trail] : trails_) forget(trail, time_s);
  for (Path& trail : finished_) forget(trail, time_s);
  std::erase_if(finished_, [](const Path& trail) { return trail.stops.empty(); });
}

std::vector<Path> Trails::paths(double time_s) const {
  std::vector<Path> result = finished_;
  for (const auto& [id, trail] : trails_) result.push_back(trail);
  for (Path& path : result)
    for (Path::Stop& stop : path.stops) stop.age_s = time_s - stop.age_s;
  return result;
}

void Trails::finish(std::uint32_t id) {
  const auto found = trails_.find(id);
  if (found == trails_.end()) return;
  found->second.is_current = false;
  finished_.push_back(std::move(found->second));
  trails_.erase(found);
}

/// Called before a stop is added. The last stop begins the segment that is tested next; the stop before it may be
/// dropped.
void Trails::thin(Path& trail) const {
  const std::size_t count = trail.stops.size();
  if (count < 3) return;
  if (trail.stops[count - 1].age_s - trail.stops[count - 3].age_s < length_s_ / kMostStops)
    trail.stops.erase(trail.stops.end() - 2);
}

/// Forgets old stops. The segment to the newest place stays, however old its beginning is.
void Trails::forget(Path& trail, double time_s) const {
  const auto is_young = [&](const Path::Stop& stop) { return time_s - stop.age_s <= length_s_ + 1e-9; };
  auto first = std::ranges::find_if(trail.stops, is_young);
  if (trail.is_current && std::distance(first, trail.stops.end()) < 2 && first != trail.stops.begin()) --first;
  trail.stops.erase(trail.stops.begin(), first);
}

}  // namespace vestige::plot
