#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "traces/motion/bvh.hpp"
#include "traces/motion/up_axis.hpp"
#include "traces/scene/avatar.hpp"

namespace vestige {

/// A joint of the motion and the avatar's node that follows it.
struct JointMatch {
  std::string joint;
  std::string node;
  enum class How { kName, kRole } how = How::kName;
};

/// How a motion is transferred.
struct RetargetOptions {
  std::optional<double> metres_per_unit = {};  ///< scale of the body's travel; otherwise the ratio of both bodies' legs
  std::optional<glm::dvec3> up = {};           ///< the direction that is up in the motion's file; otherwise find_up's
  /// The remedy of the error that refuses a body that leans another way than the motion's. Nothing: it is accepted.
  std::optional<std::string> refusal = "retarget without a refusal";
};

/// A direction of the body that differs between motion and avatar.
struct Deviation {
  std::string what;       ///< "upperArm_L to lowerArm_L", by the motion's joints
  double degrees = 0;     ///< the most in any frame
  std::size_t frame = 0;  ///< the frame in which it is
};

/// The result of a retargeting.
struct RetargetReport {
  std::vector<JointMatch> matched;            ///< in the motion's order
  std::vector<std::string> unmatched_joints;  ///< joints of the motion that no node follows
  std::vector<std::string> unmatched_nodes;   ///< nodes that move the avatar's vertices and keep their rest transform
  double height = 0;                          ///< height of the motion's skeleton, in its own unit
  double metres_per_unit = 0;                 ///< scale of the body's travel
  std::string likely_unit;  ///< "cm", …: the unit in which the skeleton is as tall as a person; empty if there is none
  UpAxis up;
  std::vector<Deviation> deviations;  ///< the directions that differ by more than their tolerance, see retarget()
};

/// Bones may differ by this angle before the report names them; the direction in which the body faces by three times
/// it.
inline constexpr double kBoneTolerance_deg = 5;
/// A body whose direction from hips to head differs by more in any frame is refused.
inline constexpr double kBodyTolerance_deg = 30;

/// Transfers a motion to the avatar. Returns an `Animation` with one key a frame.
///
/// Bones of the avatar point where the motion's bones point. A matched node turns in the world as its joint does. Which
/// way it is turned while the joint's rotation is zero depends on the motion's skeleton:
/// - It rests as a standing person does, in whatever direction it lies (is_person): the node counts from its own rest
///   pose. Arms and legs that point another way there (an A pose, a T pose) are first turned to the motion's.
/// - It rests in any other shape: the frames tell. The hips' axes follow from hip joints and neck. Every other joint is
///   turned as its parent is on average over the motion, and then by the shortest way to the direction of its bone.
/// The motion's up (find_up) becomes +Y. What the motion's skeleton faces at rest becomes what the avatar faces
/// (`Avatar::facing`). If its rest pose tells nothing, what the body faces in the first frame does, to the nearest axis
/// of the file.
///
/// The hips travel as the motion's hips do, scaled by `metres_per_unit`, so that feet do not slide. The travel counts
/// horizontally from the avatar's own place, and vertically from the height of the hips at rest, or from the motion's
/// floor if that makes no sense.
///
/// The animation is then played and compared with the motion in every frame: bones' directions within
/// kBoneTolerance_deg, the directions from hips to head and from right hip to left hip within three times that, and the
/// sides of the hands. The report names what differs by more.
///
/// Joints are matched by their role in a body (body_roles.hpp), spines from both ends, then the rest by name. Throws
/// `Error` with the motion's name if the avatar does not stand (`AvatarFacing::lies_deg`), or if the hips, or both an
/// arm and a leg, match nothing (nodes with a `fixed_matrix` do not count). With a `refusal`, throws it also if the
/// direction from hips to head differs by more than kBodyTolerance_deg. Also throws if the animation would hold more
/// than 2^26 numbers, or many more than the motion has.
Animation retarget(const BvhMotion& motion, const Avatar& avatar, const RetargetOptions& options,
                   const std::string& name, RetargetReport& report);

}  // namespace vestige
