#include "analysis/frequency/sweep_scene.hpp"

#include <algorithm>
#include <glm/vec3.hpp>
#include <iterator>

namespace vestige {

namespace {

/// Between two copies: more than people and colliders of a measured trace are apart.
constexpr double kDistance_m = 64;

/// Gives the colliders of each copy ids of their own: their places in the trace's list, then those after it.
class CopiedIds {
 public:
  CopiedIds(std::span<const std::uint32_t> ids, Crowd crowd)
      : ids_(ids), copies_(crowd.first_only ? 1 : crowd.copies) {}

  std::uint32_t copies() const { return copies_; }

  std::uint32_t id(std::uint32_t of_trace, std::uint32_t copy) const {
    const auto place = static_cast<std::uint32_t>(std::ranges::lower_bound(ids_, of_trace) - ids_.begin());
    return place + copy * static_cast<std::uint32_t>(ids_.size());
  }

  DrawnIds all(const DrawnIds& of_trace) const {
    DrawnIds copied;
    copied.reserve(of_trace.size() * copies_);
    for (std::uint32_t copy = 0; copy < copies_; ++copy)
      for (const std::uint32_t one : of_trace) copied.push_back(id(one, copy));
    return copied;
  }

 private:
  std::span<const std::uint32_t> ids_;
  std::uint32_t copies_;
};

TraceFrame with_copies(const TraceFrame& frame, std::uint32_t people, const CopiedIds& ids) {
  const auto shift_m = [](std::uint32_t copy) { return glm::dvec3(kDistance_m * copy, 0, 0); };
  TraceFrame copied;
  copied.index = frame.index;
  copied.time_ns = frame.time_ns;
  copied.poses.clear();
  for (std::uint32_t copy = 0; copy < people; ++copy)
    for (const Pose& pose : frame.poses) copied.poses.emplace_back(pose).origin_m += shift_m(copy);
  copied.colliders.reserve(frame.colliders.size() * ids.copies());
  for (std::uint32_t copy = 0; copy < ids.copies(); ++copy) {
    for (const ColliderSample& one : frame.colliders) {
      ColliderSample& collider = copied.colliders.emplace_back(one);
      collider.id = ids.id(one.id, copy);
      collider.position_m += shift_m(copy);
      if (one.owner != kNobody) collider.owner = static_cast<std::uint16_t>(one.owner + copy * frame.poses.size());
    }
    for (const std::uint32_t id : frame.teleported) copied.teleported.push_back(ids.id(id, copy));
  }
  return copied;
}

}  // namespace

SweepScene make_sweep_scene(std::vector<Place> places, std::span<const std::uint32_t> ids,
                            const std::vector<std::uint32_t>& counts, std::uint64_t seed) {
  SweepScene scene;
  scene.places = std::move(places);
  scene.drawn_for_any.resize(scene.places.size());
  for (const std::uint32_t count : counts) {
    scene.drawn.push_back(draw_colliders(ids, count, scene.places.size(), seed));
    for (std::size_t i = 0; i < scene.places.size(); ++i) {
      DrawnIds both;
      std::ranges::set_union(scene.drawn_for_any[i], scene.drawn.back()[i], std::back_inserter(both));
      scene.drawn_for_any[i] = std::move(both);
    }
  }
  return scene;
}

SweepScene with_copies(const SweepScene& scene, std::span<const std::uint32_t> ids, Crowd crowd) {
  if (crowd.copies == 1) return scene;
  const CopiedIds copied_ids(ids, crowd);
  SweepScene copied = scene;
  for (Place& place : copied.places)
    for (TraceFrame& frame : place) frame = with_copies(frame, crowd.copies, copied_ids);
  for (auto& places : copied.drawn)
    for (DrawnIds& drawn : places) drawn = copied_ids.all(drawn);
  for (DrawnIds& drawn : copied.drawn_for_any) drawn = copied_ids.all(drawn);
  return copied;
}

}  // namespace vestige
