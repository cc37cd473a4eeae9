#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <vector>

#include "traces/body/limbs.hpp"
#include "traces/scene/avatar.hpp"
#include "traces/scene/trace.hpp"

namespace vestige {

/// People's limbs, which frames get as colliders that belong to them.
class CarriedLimbs {
 public:
  /// The spheres get the ids from `first_id` on, in the order in which they are added.
  explicit CarriedLimbs(std::uint32_t first_id) : next_id_(first_id) {}

  /// `person` counts from 0. Keeps a reference to the avatar.
  void add(std::size_t person, const Avatar& avatar, const std::vector<LimbSphere>& spheres);
  std::size_t sphere_count() const { return sphere_count_; }

  /// Adds all limbs to a frame, where its poses put them; those of a pose that is missing stay away.
  void carry(TraceFrame& frame);

 private:
  struct OfPerson {
    std::size_t person;
    const Avatar& avatar;
    std::uint32_t first_id;
    std::vector<LimbSphere> spheres;
  };

  std::vector<OfPerson> people_;
  std::uint32_t next_id_;
  std::size_t sphere_count_ = 0;
  std::vector<glm::dmat4> world_;
};

}  // namespace vestige
