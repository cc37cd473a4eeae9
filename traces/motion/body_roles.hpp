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

/// Which bone of a body a joint is.
struct BodyRole {
  BodyPart part = BodyPart::kHips;
  BodySide side = BodySide::kNone;
  int segment = 0;  ///< of a finger, from 1 at the hand; of a spine, from 0 at the hips

  bool operator==(const BodyRole&) const = default;
};

struct NamedJoint {
  std::string name;
  int parent = -1;  ///< an earlier joint, -1 for a root
};

/// The role of each joint, as its name says it and the skeleton confirms it; each role at most once. Knows the names of
/// Mixamo, HumanIK, CMU, Biovision, 3ds Max Biped, Poser, MakeHuman, Rigify, Unity and VRM, in any case, with any
/// prefix, with sides as "Left", "L" or "left" at either end; and limbs whose joints are only numbered.
std::vector<std::optional<BodyRole>> body_roles(std::span<const NamedJoint> joints);

/// The same of an avatar's nodes.
std::vector<std::optional<BodyRole>> body_roles(const Avatar& avatar);

/// A name without what programs put in front of it ("mixamorig:"), in small letters and digits only.
std::string plain_joint_name(std::string_view name);

}  // namespace vestige
