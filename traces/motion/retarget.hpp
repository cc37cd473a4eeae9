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

/// What became of a motion on an avatar.
struct RetargetReport {
  std::vector<JointMatch> matched;            ///< in the motion's order
  std::vector<std::string> unmatched_joints;  ///< of the motion: nothing follows them
  std::vector<std::string> unmatched_nodes;   ///< of the avatar, of those that move its vertices: they keep their rest
  double height = 0;                          ///< of the motion's skeleton at rest, in its own unit
  double metres_per_unit = 0;                 ///< by which the body's travel was scaled
  std::string likely_unit;  ///< "cm", …, in which the skeleton is as tall as a person; empty: in none
};

/// The motion as the avatar does it, an `Animation` with a key a frame.
///
/// A matched node turns in the world as its joint does, counted from the rest of both; arms and legs that point another
/// way at rest (an A pose, a T pose) are first turned to where the motion's point. Axes (which way is up, and left) are
/// found from both skeletons at rest. The hips travel as the motion's do: scaled by the ratio of both hips' heights
/// above the lowest foot, so that feet do not slide, or by `metres_per_unit`; horizontally from the avatar's own place,
/// and vertically from where the hips stand at rest.
///
/// Joints are matched by their role in a body (body_roles.hpp), spines from both ends, then the rest by name. Throws
/// `Error` naming the motion where the hips, or both an arm and a leg, match nothing (nodes with a `fixed_matrix` do
/// not count), and where the animation would hold more than 2^26 numbers, or many more than the motion has.
Animation retarget(const BvhMotion& motion, const Avatar& avatar, std::optional<double> metres_per_unit,
                   const std::string& name, RetargetReport& report);

}  // namespace vestige
