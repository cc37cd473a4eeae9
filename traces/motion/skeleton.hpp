#pragma once

#include <cstddef>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "traces/body/body_roles.hpp"
#include "traces/motion/bvh.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige {

/// A skeleton at rest, of a motion or an avatar: joints with parents before children.
struct Skeleton {
  std::vector<NamedJoint> joints;
  std::vector<std::optional<BodyRole>> roles;
  std::vector<glm::dvec3> position;  ///< in the world, in metres or in the motion's unit
  std::vector<bool> usable;          ///< false if the joint's transform is fixed
};

inline constexpr BodyRole kHips = {BodyPart::kHips, BodySide::kNone, 0};

/// Returns the joint with this role.
std::optional<std::size_t> find_role(const Skeleton& skeleton, const BodyRole& role);

/// Returns the motion's skeleton with all rotations zero. `frames` are places of all joints at some times: joints below
/// the hips that have channels of position rest at the mean of their offsets from the parent there, since these
/// channels replace the offset of the file.
Skeleton skeleton_of(const BvhMotion& motion, const std::vector<std::vector<BvhPlace>>& frames);

/// Returns the avatar's skeleton; its joints are in the order of `avatar.node_order`. `rest` are the world matrices of
/// its nodes at rest.
Skeleton skeleton_of(const Avatar& avatar, const std::vector<glm::dmat4>& rest);

/// Returns the rotation of a matrix without its scale.
glm::dquat rotation_of(const glm::dmat4& matrix);

/// Returns the unit vector of the axis closest to `direction`, perpendicular to the axis `other`. Returns `fallback` if
/// `direction` has no such component.
glm::dvec3 nearest_axis(const glm::dvec3& direction, const glm::dvec3& other, const glm::dvec3& fallback);

/// Returns the body's directions left, up and forward as columns, each the axis closest to it.
glm::dmat3 axes_of(const Skeleton& skeleton);

/// Returns whether the skeleton at rest has the shape of a standing person, in whatever direction it lies: legs down,
/// head up, left joints on the left.
bool is_person(const Skeleton& skeleton, const glm::dmat3& axes);

/// Returns the height of the hips above the lowest joint of the legs; 0 if the skeleton lacks one of them.
double hip_height(const Skeleton& skeleton, const glm::dvec3& up);

/// Returns the mean length of the legs from hip joint to ankle; 0 if no leg is complete.
double leg_length(const Skeleton& skeleton);

/// Returns the shortest rotation from one direction to another, or the identity if either has length 0.
glm::dquat turn(const glm::dvec3& from, const glm::dvec3& to);

}  // namespace vestige
