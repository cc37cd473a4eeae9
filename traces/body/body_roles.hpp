#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "traces/scene/avatar.hpp"

namespace vestige {

enum class BodyPart {
  kHips,
  kSpine,  ///< any bone between hips and neck
  kNeck,
  kHead,
  kJaw,
  kEye,
  kShoulder,  ///< the collar bone
  kUpperArm,
  kLowerArm,
  kHand,
  kThumb,
  kIndex,
  kMiddle,
  kRing,
  kLittle,
  kUpperLeg,
  kLowerLeg,
  kFoot,
  kToes,
};

enum class BodySide { kNone, kLeft, kRight };

/// The bone of a body that a joint corresponds to.
struct BodyRole {
  BodyPart part = BodyPart::kHips;
  BodySide side = BodySide::kNone;
  int segment = 0;  ///< index along a finger, from 1 at the hand, or along the spine, from 0 at the hips

  bool operator==(const BodyRole&) const = default;
};

struct NamedJoint {
  std::string name;
  int parent = -1;  ///< an earlier joint, -1 for a root
};

/// Returns the role of each joint, derived from its name and confirmed by the skeleton; each role occurs at most once.
/// Knows the names of Mixamo, HumanIK, CMU, Biovision, 3ds Max Biped, Poser, MakeHuman, Rigify, Unity and VRM. Names
/// may have any case and any prefix, with sides as "Left", "L" or "left" at either end. Also knows limbs whose joints
/// are only numbered.
std::vector<std::optional<BodyRole>> body_roles(std::span<const NamedJoint> joints);

/// Returns an avatar's nodes in the order of `avatar.node_order`.
std::vector<NamedJoint> named_joints(const Avatar& avatar);

/// Returns the outermost joints of those skeletons of an avatar that are bodies by their names, with hips and an arm or
/// a leg, in the order of `avatar.node_order`. Several meshes with the same joints have one skeleton.
std::vector<std::size_t> bodies_of(const Avatar& avatar);

/// Returns the roles of an avatar's nodes: those that the table of VRM gives, and otherwise those that the names tell.
/// Of several bodies (`bodies_of`), the names of the first count.
std::vector<std::optional<BodyRole>> body_roles(const Avatar& avatar);

/// Returns a name without the prefix that some programs add ("mixamorig:"), in lower-case letters and digits only.
std::string plain_joint_name(std::string_view name);

}  // namespace vestige
