#pragma once

#include <optional>
#include <string>
#include <vector>

#include "traces/motion/bvh.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige {

/// A joint of the motion and the avatar's node that follows it.
struct JointMatch {
  std::string joint;
  std::string node;
  enum class How { kName, kRole } how = How::kName;
};

/// The result of a retargeting.
struct RetargetReport {
  std::vector<JointMatch> matched;            ///< in the motion's order
  std::vector<std::string> unmatched_joints;  ///< joints of the motion that no node follows
  std::vector<std::string> unmatched_nodes;   ///< nodes that move the avatar's vertices and keep their rest transform
  double height = 0;                          ///< height of the motion's skeleton at rest, in its own unit
  double metres_per_unit = 0;                 ///< scale of the body's travel
  std::string likely_unit;  ///< "cm", …: the unit in which the skeleton is as tall as a person; empty if there is none
};

/// Transfers a motion to the avatar. Returns an `Animation` with one key a frame.
///
/// A matched node turns in the world as its joint does, counted from the rest pose of both. Arms and legs that point
/// another way at rest (an A pose, a T pose) are first turned to the direction of the motion's. The axes (which way is
/// up, and left) are found from both skeletons at rest. The hips travel as the motion's hips do. The travel is scaled
/// by `metres_per_unit`, or otherwise by the ratio of both hips' heights above the lowest foot, so that feet do not
/// slide. It counts horizontally from the avatar's own place, and vertically from the height of the hips at rest.
///
/// Joints are matched by their role in a body (body_roles.hpp), spines from both ends, then the rest by name. Throws
/// `Error` with the motion's name if the hips, or both an arm and a leg, match nothing (nodes with a `fixed_matrix` do
/// not count). Also throws if the animation would hold more than 2^26 numbers, or many more than the motion has.
Animation retarget(const BvhMotion& motion, const Avatar& avatar, std::optional<double> metres_per_unit,
                   const std::string& name, RetargetReport& report);

}  // namespace vestige
