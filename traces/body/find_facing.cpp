#include "traces/body/find_facing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/trigonometric.hpp>
#include <vector>

#include "traces/scene/pose.hpp"

namespace vestige {

namespace {

/// A direction tells nothing if less than this share of its length is horizontal.
constexpr double kLevel = 0.5;
/// The least cosine between a direction and the nearest axis: 30 degrees.
constexpr double kNear = 0.866;
/// The least cosine between +Y and a trunk that stands, and between -Y and legs that carry it: 45 degrees, where a
/// direction is as near to the floor as to the upright.
constexpr double kUpright = 0.7071;

/// The places of the bones of an avatar at rest.
class Bones {
 public:
  Bones(const Avatar& avatar, const Humanoid& humanoid) : humanoid_(humanoid) {
    world_matrices(avatar, rest_pose(avatar), world_);
  }

  /// Returns the way from one bone to another; 0 if a bone is missing.
  glm::dvec3 whole_way(const std::string& from, const std::string& to) const {
    const auto a = humanoid_.node_of.find(from);
    const auto b = humanoid_.node_of.find(to);
    if (a == humanoid_.node_of.end() || b == humanoid_.node_of.end()) return glm::dvec3(0);
    return glm::dvec3(world_[b->second][3]) - glm::dvec3(world_[a->second][3]);
  }

  /// Returns the way from one bone to another without its height; 0 if a bone is missing or the way is steep.
  glm::dvec3 way(const std::string& from, const std::string& to) const {
    const glm::dvec3 whole = whole_way(from, to);
    const glm::dvec3 level(whole.x, 0, whole.z);
    return glm::length(level) > kLevel * glm::length(whole) ? level : glm::dvec3(0);
  }

 private:
  const Humanoid& humanoid_;
  std::vector<glm::dmat4> world_;
};

/// Returns the direction with length 1, or nothing if it has no length.
std::optional<glm::dvec3> direction_of(const glm::dvec3& way) {
  const double length = glm::length(way);
  if (!(length > 0) || !std::isfinite(length)) return std::nullopt;
  return way / length;
}

/// Returns `AvatarFacing::lies_deg`.
std::optional<double> lies_deg(const Bones& bones) {
  const auto trunk = direction_of(bones.whole_way("Hips", "Head"));
  if (!trunk || trunk->y >= kUpright) return {};
  glm::dvec3 legs(0);
  for (const std::string side : {"Left", "Right"}) {
    const glm::dvec3 thigh = bones.whole_way(side + "UpperLeg", side + "LowerLeg");
    legs += thigh != glm::dvec3(0) ? thigh : bones.whole_way(side + "LowerLeg", side + "Foot");
  }
  if (const auto down = direction_of(legs); down && down->y <= -kUpright) return {};
  return glm::degrees(std::acos(std::clamp(trunk->y, -1.0, 1.0)));
}

void add_doubt(AvatarFacing& facing, const std::string& cause) {
  facing.doubt += fmt::format("{}{}", facing.doubt.empty() ? "" : "; ", cause);
}

}  // namespace

AvatarFacing find_facing(const Avatar& avatar, const Humanoid& humanoid) {
  const Bones bones(avatar, humanoid);
  AvatarFacing facing;
  facing.lies_deg = lies_deg(bones);
  if (facing.lies_deg) return facing;
  constexpr std::array kPaired = {"UpperLeg", "Shoulder", "UpperArm", "Hand"};
  glm::dvec3 leftwards(0);
  for (const std::string pair : kPaired)  // a vote each, however far apart they are
    leftwards += direction_of(bones.way("Right" + pair, "Left" + pair)).value_or(glm::dvec3(0));
  const auto feet = direction_of(bones.way("LeftFoot", "LeftToes") + bones.way("RightFoot", "RightToes"));

  facing.left = direction_of(leftwards);
  std::optional<glm::dvec3> forward;
  if (facing.left) {
    forward = forward_from_left(*facing.left);
    facing.by = AvatarFacing::By::kSides;
  } else if (feet) {
    forward = feet;
    facing.by = AvatarFacing::By::kFeet;
  } else if (humanoid.source != Humanoid::Source::kNames) {
    forward = forward_of(humanoid.source == Humanoid::Source::kVrm0 ? Facing::kMinusZ : Facing::kPlusZ);
    facing.by = AvatarFacing::By::kVrm;
  }
  if (!forward) {
    add_doubt(facing, "neither its joints' names nor VRM tell which way it faces");
    return facing;
  }
  facing.axis = nearest_facing(*forward);
  const glm::dvec3 axis = forward_of(facing.axis);
  if (glm::dot(*forward, axis) < kNear) add_doubt(facing, "it faces between two axes");
  for (const std::string pair : kPaired)
    if (facing.left && glm::dot(bones.way("Right" + pair, "Left" + pair), *facing.left) < 0)
      add_doubt(facing, fmt::format("its joints Left{0} and Right{0} lie the other way round than the others", pair));
  if (feet && glm::dot(*feet, axis) < 0)
    add_doubt(facing, fmt::format("its feet point to {}", to_string(nearest_facing(*feet))));
  if (humanoid.source == Humanoid::Source::kVrm0 && facing.axis != Facing::kMinusZ)
    add_doubt(facing, "VRM 0.x faces -z");
  if (humanoid.source == Humanoid::Source::kVrm1 && facing.axis != Facing::kPlusZ)
    add_doubt(facing, "VRM 1.0 faces +z");
  return facing;
}

}  // namespace vestige
