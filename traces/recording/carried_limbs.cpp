#include "traces/recording/carried_limbs.hpp"

#include "traces/places/body.hpp"

namespace vestige {

void CarriedLimbs::add(std::size_t person, const Avatar& avatar, const std::vector<LimbSphere>& spheres) {
  people_.push_back({person, avatar, next_id_, spheres});
  next_id_ += static_cast<std::uint32_t>(spheres.size());
  sphere_count_ += spheres.size();
}

void CarriedLimbs::carry(TraceFrame& frame) {
  for (const OfPerson& of : people_) {
    const Pose& pose = frame.poses[of.person];
    if (pose.nodes.empty()) continue;
    world_matrices(of.avatar, pose, world_);
    std::uint32_t id = of.first_id;
    for (const LimbSphere& sphere : of.spheres) {
      const glm::dvec3 place_m(world_[sphere.node] * glm::dvec4(sphere.centre, 1));
      frame.colliders.push_back({.id = id++,
                                 .position_m = pose.origin_m + on_grid(place_m),
                                 .radius_m = sphere.radius_m,
                                 .owner = static_cast<std::uint16_t>(of.person + 1)});
    }
  }
}

}  // namespace vestige
