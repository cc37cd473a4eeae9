#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "detector/actuator_map.hpp"
#include "detector/contact.hpp"
#include "detector/decision.hpp"
#include "traces/scene/avatar.hpp"
#include "traces/scene/box.hpp"

namespace vestige {

/// Some triangles of an avatar, and where they lie.
class RestPatch {
 public:
  /// `triangles` and `corners` are of equal size, and not empty.
  RestPatch(std::vector<std::uint32_t> triangles, std::vector<Corners> corners);

  std::span<const std::uint32_t> triangles() const { return triangles_; }
  std::span<const Corners> corners() const { return corners_; }
  /// Returns the squared distance from a point to the box around the patch: no triangle is nearer.
  double distance_squared_at_least(const glm::dvec3& point) const;

 private:
  std::vector<std::uint32_t> triangles_;
  std::vector<Corners> corners_;
  Box box_;
};

/// A place of the skin, as a contact tells it: its triangle, barycentric, texture coordinate and actuator. The other
/// members are at their defaults.
using SkinSpot = Contact;

/// Returns the place of the patches nearest to a point; of places equally near, the first. Precondition: there is a
/// patch.
SkinSpot nearest_spot(const Avatar& avatar, const ActuatorMap& map, std::span<const RestPatch> patches,
                      const glm::dvec3& point);

/// Copies a place of the skin into a contact. The contact's t, side, position and speed stay.
void put_spot(const SkinSpot& spot, Contact& contact);

}  // namespace vestige
