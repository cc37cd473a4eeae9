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

/// 21 joints, parents first; those of the right side follow their left twins' order.
const std::vector<Joint>& skeleton();

/// The index of a joint by name; it must exist.
std::size_t joint(const std::string& name);

/// Rotations of all joints in their parents' frames, and where the root is.
struct JointPose {
  std::vector<glm::dquat> rotations;
  glm::dvec3 root_m;
};
JointPose rest_pose();

/// Where a point that lies at `point_m` in the rest pose and moves with `joint` is in `pose`.
glm::dvec3 posed(const JointPose& pose, std::size_t joint, const glm::dvec3& point_m);

constexpr std::size_t kVertexInfluences = 4;
struct VertexWeights {
  std::array<std::uint8_t, kVertexInfluences> joints = {};
  std::array<float, kVertexInfluences> weights = {};  ///< sum to 1 but for rounding, descending, unused ones 0
};

/// Each vertex belongs to the bone whose stretch of the body it lies in; then the borders diffuse along the surface
/// (implicit heat flow), wider at hip and shoulder than at wrist and neck, so that no joint creases or collapses.
std::vector<VertexWeights> skin_weights(const Surface& surface);

}  // namespace vestige::mannequin
