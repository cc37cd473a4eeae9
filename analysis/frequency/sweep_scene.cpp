#include "analysis/frequency/sweep_scene.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <iterator>
#include <limits>

namespace vestige {

namespace {

/// The least distance between two copies.
constexpr double kLeastDistance_m = 64;

/// What a scene reaches along x.
struct Reach {
  double low_m = std::numeric_limits<double>::infinity();
  double high_m = -std::numeric_limits<double>::infinity();

  void take(double x_m, double around_m) {
    if (!std::isfinite(x_m) || !std::isfinite(around_m)) return;
    low_m = std::min(low_m, x_m - around_m);
    high_m = std::max(high_m, x_m + around_m);
  }
};

/// Returns a distance at which no copy reaches another: a power of two, so that copies hardly differ by rounding.
double distance_m(const std::vector<Place>& places) {
  Reach reach;
  for (const Place& place : places)
    for (const TraceFrame& frame : place) {
      for (const Pose& pose : frame.poses) {
        double around_m = 0;  // no joint is farther from the origin, as long as nothing is scaled
        for (const NodeLocal& node : pose.nodes) around_m += glm::length(glm::dvec3(node.translation));
        reach.take(pose.origin_m.x, around_m);
      }
      for (const ColliderSample& collider : frame.colliders) reach.take(collider.position_m.x, collider.radius_m);
    }
  const double most_m = std::max(2 * (reach.high_m - reach.low_m), kLeastDistance_m);
  return std::exp2(std::ceil(std::log2(most_m)));
}

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

/// `ids` are ascending.
void keep_only(const DrawnIds& ids, TraceFrame& frame) {
  std::erase_if(frame.colliders, [&](const ColliderSample& one) { return !std::ranges::binary_search(ids, one.id); });
  frame.colliders.shrink_to_fit();
}

TraceFrame with_copies(const TraceFrame& frame, std::uint32_t people, const CopiedIds& ids, double apart_m) {
  const auto shift_m = [apart_m](std::uint32_t copy) { return glm::dvec3(apart_m * copy, 0, 0); };
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
  for (std::size_t i = 0; i < scene.places.size(); ++i)
    for (TraceFrame& frame : scene.places[i]) keep_only(scene.drawn_for_any[i], frame);
  return scene;
}

SweepScene with_copies(const SweepScene& scene, std::span<const std::uint32_t> ids, Crowd crowd) {
  if (crowd.copies == 1) return scene;
  const CopiedIds copied_ids(ids, crowd);
  const double apart_m = distance_m(scene.places);
  SweepScene copied = scene;
  for (Place& place : copied.places)
    for (TraceFrame& frame : place) frame = with_copies(frame, crowd.copies, copied_ids, apart_m);
  for (auto& places : copied.drawn)
    for (DrawnIds& drawn : places) drawn = copied_ids.all(drawn);
  for (DrawnIds& drawn : copied.drawn_for_any) drawn = copied_ids.all(drawn);
  return copied;
}

}  // namespace vestige
