#pragma once

#include <glm/vec3.hpp>
#include <string>

#include "traces/scene/avatar.hpp"
#include "traces/scene/facing.hpp"

namespace vestige {

/// Where a person stands in a scene, and which way they look: turned about +Y, then moved. Turning by whole right
/// angles is exact.
struct Stance {
  glm::dvec3 position_m = glm::dvec3(0);  ///< relative to the scene's origin
  double cosine = 1;                      ///< of the angle, counter-clockwise from above
  double sine = 0;

  bool is_turned() const { return sine != 0 || cosine != 1; }
  /// Turns a place or a direction of the avatar's own frame.
  glm::dvec3 turned(const glm::dvec3& p) const { return {cosine * p.x + sine * p.z, p.y, cosine * p.z - sine * p.x}; }
};

/// Returns the stance of a person at this position who looks along +Z turned by `yaw_deg`, counter-clockwise from
/// above, whatever axis the avatar looks along at rest.
Stance stance_of(const glm::dvec3& position_m, double yaw_deg, Facing facing);

/// Returns the name of a root node that no pose can turn, because its transform is a fixed matrix that is no rotation,
/// translation and scale; empty if there is none.
std::string unturnable_root(const Avatar& avatar);

/// Turns the avatar's root nodes, and moves the pose's origin. A stance that is not turned leaves the nodes' bits
/// alone.
void move_to(const Stance& stance, const Avatar& avatar, Pose& pose);

}  // namespace vestige
