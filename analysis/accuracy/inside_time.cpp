#include "analysis/accuracy/inside_time.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "detector/algebra/winding_number.hpp"
#include "detector/frame.hpp"
#include "detector/skinning.hpp"
#include "traces/scene/welding.hpp"

namespace vestige {

namespace {

constexpr double kLooks_hz = 60;

/// Whether every edge occurs as often in one direction as in the other.
bool is_closed(const Avatar& avatar) {
  const std::vector<std::uint32_t> place = weld_places(avatar.position_bind);
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> surplus;  // of the direction to the larger number
  for (const glm::uvec3& corner : avatar.triangles)
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t from = place[corner[i]];
      const std::uint32_t to = place[corner[(i + 1) % 3]];
      if (from != to) surplus[std::minmax(from, to)] += from < to ? 1 : -1;
    }
  return std::ranges::all_of(surplus, [](const auto& edge) { return edge.second == 0; });
}

/// Whether a true touch of a collider is under way.
bool touches(const TrueContacts& truth, std::uint32_t column, double time_s) {
  const double step_s = 1 / truth.rate_hz;
  return std::ranges::any_of(truth.events, [&](const ContactEvent& touch) {
    return touch.column == column && touch.impact_s <= time_s + step_s && touch.last_s >= time_s - step_s;
  });
}

}  // namespace

std::optional<double> inside_s(const MovingScene& scene, const TrueContacts& truth) {
  if (!is_closed(scene.avatar)) return {};
  SceneSampler sampler(scene, kLooks_hz);
  FrameBuilder builder(scene.avatar, scene.collider_ids);
  std::vector<glm::vec3> skin;
  double inside_s = 0;
  for (std::uint64_t frame = 0; frame <= last_frame_within(scene, kLooks_hz); ++frame) {
    const DetectorFrame& now = builder.next(sampler.next());
    skin_vertices(scene.avatar, now.palette, skin);
    for (const Segment& segment : now.segments)
      if (segment.is_sphere() && !touches(truth, segment.column, now.time_s) &&
          winding_number(skin, scene.avatar.triangles, segment.end).value_or(0) != 0)
        inside_s += 1 / kLooks_hz;
  }
  return inside_s;
}

}  // namespace vestige
