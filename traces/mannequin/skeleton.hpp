#pragma once

#include <array>
#include <cstddef>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "traces/mannequin/surface.hpp"

namespace vestige::mannequin {

/// A joint; in the rest pose its axes are the world's.
struct Joint {
  std::string name;
  int parent;  ///< index of an earlier joint, -1 for the root
  glm::dvec3 position_m;
};

/// Returns the 21 joints, parents first. The joints of the right side have the order of their left twins.
const std::vector<Joint>& skeleton();

/// Returns the index of a joint by name. Precondition: the joint exists.
std::size_t joint(const std::string& name);

/// Rotations of all joints in their parents' frames, and the position of the root.
struct JointPose {
  std::vector<glm::dquat> rotations;
  glm::dvec3 root_m;
};
JointPose rest_pose();

/// Returns the position in `pose` of a point that is at `point_m` in the rest pose and moves with `joint`.
glm::dvec3 posed(const JointPose& pose, std::size_t joint, const glm::dvec3& point_m);

constexpr std::size_t kVertexInfluences = 4;
struct VertexWeights {
  std::array<std::uint8_t, kVertexInfluences> joints = {};
  std::array<float, kVertexInfluences> weights = {};  ///< sum to 1 except for rounding, descending, unused ones 0
};

/// Returns the weights of each vertex. A vertex first belongs to the bone whose section of the body contains it. Then
/// the borders diffuse along the surface (implicit heat flow), wider at hip and shoulder than at wrist and neck, so
/// that no joint creases or collapses.
std::vector<VertexWeights> skin_weights(const Surface& surface);

}  // namespace vestige::mannequin
