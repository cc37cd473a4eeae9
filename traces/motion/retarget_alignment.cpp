#include <fmt/format.h>

#include <cmath>
#include <map>
#include <set>

#include "traces/base/error.hpp"
#include "traces/motion/joint_matching.hpp"
#include "traces/motion/retargeter.hpp"
#include "traces/motion/up_axis.hpp"

namespace vestige {

namespace {

using Index = std::size_t;

}  // namespace

Retargeter::Retargeter(const BvhMotion& motion, const Avatar& avatar, const RetargetOptions& options,
                       const std::string& name)
    : motion_(motion),
      avatar_(avatar),
      name_(name),
      samples_(sample_motion(motion)),
      source_(skeleton_of(motion, samples_.now)) {
  require_standing(avatar.facing, name);
  world_matrices(avatar, rest_pose(avatar), rest_);
  target_ = skeleton_of(avatar, rest_);
  follows_ = match_joints(source_, target_);
  refuse_other_bodies();
  find_axes(options.up);
  metres_per_unit_ = options.metres_per_unit ? *options.metres_per_unit : ratio_of_legs();
  if (rests_as_person_)
    align();
  else
    align_by_frames();
}

void Retargeter::refuse_other_bodies() const {
  bool arm = false;
  bool leg = false;
  for (const BodySide side : {BodySide::kLeft, BodySide::kRight}) {
    arm = arm || followed({BodyPart::kUpperArm, side, 0});
    leg = leg || followed({BodyPart::kUpperLeg, side, 0});
  }
  if (followed(kHips) && (arm || leg)) return;
  std::vector<std::string> names;
  for (const NamedJoint& joint : source_.joints)
    if (names.size() < 8) names.push_back(shown_word(joint.name));
  throw Error(name_,
              fmt::format("its joints ({}{}) do not match both the hips and a limb of the avatar",
                          fmt::join(names, ", "), source_.joints.size() > names.size() ? ", …" : ""),
              "rename the joints as VRM, Mixamo or CMU name them: hips, spine, leftUpperArm, …");
}

/// Finds the axes of the world and of both bodies.
void Retargeter::find_axes(const std::optional<glm::dvec3>& up) {
  const glm::dmat3 source_axes = axes_of(source_);
  const Facing faces = avatar_.facing.axis;
  const glm::dmat3 target_axes(turned_from_front({1, 0, 0}, faces), kUp, forward_of(faces));
  rests_as_person_ = is_person(source_, source_axes);
  if (rests_as_person_) body_to_avatar_ = target_axes * glm::transpose(source_axes);
  up_ = up ? UpAxis{*up, UpAxis::By::kAsked}
           : find_up(motion_, body(), samples_, rests_as_person_ ? std::optional(source_axes[1]) : std::nullopt);
  if (rests_as_person_ && up_.up == source_axes[1]) {
    to_avatar_ = body_to_avatar_;
    return;
  }
  // What the skeleton at rest does not tell: the body faces forward in the first frame.
  glm::dvec3 left(0);
  for (const BodyPart part : {BodyPart::kUpperLeg, BodyPart::kUpperArm, BodyPart::kShoulder}) {
    const auto left_joint = find_role(source_, {part, BodySide::kLeft, 0});
    const auto right_joint = find_role(source_, {part, BodySide::kRight, 0});
    if (left_joint && right_joint)
      left += samples_.now.front()[*left_joint].position - samples_.now.front()[*right_joint].position;
  }
  const glm::dvec3 fallback = up_.up.z == 0 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, -1, 0);
  const glm::dvec3 forward = nearest_axis(glm::cross(left, up_.up), up_.up, fallback);
  to_avatar_ = target_axes * glm::transpose(glm::dmat3(glm::cross(up_.up, forward), up_.up, forward));
}

/// Returns the joints of the motion that move the avatar's body.
std::vector<Index> Retargeter::body() const {
  std::set<Index> joints;
  for (Index node = 0; node < follows_.size(); ++node)
    if (follows_[node] && target_.roles[node]) joints.insert(*follows_[node]);
  return {joints.begin(), joints.end()};
}

/// Returns the flatter of two rotations of a foot while the motion rests. Some captures (CMU's) rest with spread legs
/// and feet turned with them, others with feet flat on the floor.
glm::dquat Retargeter::flatter(Index foot, const glm::dquat& with_leg) const {
  constexpr std::size_t kSamples = 64;
  const glm::dquat turn_to_avatar = glm::normalize(glm::quat_cast(to_avatar_));
  const glm::dquat turn_back = glm::conjugate(glm::normalize(glm::quat_cast(body_to_avatar_)));
  const std::size_t step = motion_.frame_count / kSamples + 1;
  double lead = 0;
  std::vector<BvhPlace> places;
  for (std::size_t frame = 0; frame < motion_.frame_count; frame += step) {
    bvh_places(motion_, frame, places);
    const glm::dquat turned = turn_to_avatar * places[*follows_[foot]].rotation * turn_back;
    lead += glm::dot(turned * with_leg * kUp - turned * kUp, kUp);
  }
  return lead > 0 ? with_leg : glm::dquat(1, 0, 0, 0);
}

/// Turns arms and legs to the direction of the motion's at rest. Hands and fingers turn with their arm, toes with their
/// foot. The trunk is upright in both.
void Retargeter::align() {
  at_rest_.resize(target_.joints.size());
  std::vector<glm::dquat> swing(target_.joints.size(), glm::dquat(1, 0, 0, 0));
  const std::set turned = {BodyPart::kUpperArm, BodyPart::kLowerArm, BodyPart::kUpperLeg, BodyPart::kLowerLeg};
  for (Index i = 0; i < target_.joints.size(); ++i) {
    const auto& role = target_.roles[i];
    const int parent = target_.joints[i].parent;
    const bool is_trunk =
        role && (role->side == BodySide::kNone || role->part == BodyPart::kShoulder || role->part == BodyPart::kEye);
    if (parent >= 0 && !is_trunk) swing[i] = swing[static_cast<Index>(parent)];
    if (role && follows_[i] && role->part == BodyPart::kFoot) swing[i] = flatter(i, swing[i]);
    if (role && follows_[i] && turned.contains(role->part)) {
      if (const auto end = bone_end(i)) {
        swing[i] = turn(target_.position[*end] - target_.position[i],
                        body_to_avatar_ * (source_.position[*follows_[*end]] - source_.position[*follows_[i]]));
        aligned_.emplace_back(i, *end);
      }
    }
    at_rest_[i] = swing[i] * rest_rotation(i);
  }
}

/// Returns the mean direction between two joints of the motion, in the axes of `joint`.
glm::dvec3 Retargeter::mean_direction(Index joint, Index from, Index to) const {
  glm::dvec3 sum(0);
  for (const auto& places : samples_.now)
    sum += glm::conjugate(places[joint].rotation) * (places[to].position - places[from].position);
  return sum;
}

/// Returns the mean rotation from the axes of `reference` to those of `joint`.
glm::dquat Retargeter::mean_turn(Index joint, Index reference) const {
  glm::dquat sum(0, 0, 0, 0);
  for (const auto& places : samples_.now) {
    const glm::dquat one = glm::conjugate(places[joint].rotation) * places[reference].rotation;
    sum = sum + (glm::dot(one, sum) < 0 ? -one : one);
  }
  return glm::length(sum) > 0 ? glm::normalize(sum) : glm::dquat(1, 0, 0, 0);
}

/// Returns the joint at which a bone of the avatar ends, if both skeletons have that bone.
std::optional<Index> Retargeter::bone_end(Index node) const {
  static const std::map<BodyPart, std::vector<BodyPart>> ends = {
      {BodyPart::kNeck, {BodyPart::kHead}},         {BodyPart::kShoulder, {BodyPart::kUpperArm}},
      {BodyPart::kUpperArm, {BodyPart::kLowerArm}}, {BodyPart::kLowerArm, {BodyPart::kHand}},
      {BodyPart::kUpperLeg, {BodyPart::kLowerLeg}}, {BodyPart::kLowerLeg, {BodyPart::kFoot}},
      {BodyPart::kFoot, {BodyPart::kToes}},         {BodyPart::kHand, {BodyPart::kMiddle, BodyPart::kIndex}}};
  const auto& role = target_.roles[node];
  if (!role) return {};
  std::vector<BodyRole> candidates;
  if (role->part == BodyPart::kSpine) {
    for (int segment = role->segment + 1; find_role(target_, {BodyPart::kSpine, BodySide::kNone, segment}); ++segment)
      candidates.push_back({BodyPart::kSpine, BodySide::kNone, segment});
    candidates.push_back({BodyPart::kNeck, BodySide::kNone, 0});
    candidates.push_back({BodyPart::kHead, BodySide::kNone, 0});
  } else if (role->segment > 0) {
    candidates.push_back({role->part, role->side, role->segment + 1});
  } else if (const auto known = ends.find(role->part); known != ends.end()) {
    for (const BodyPart part : known->second)
      candidates.push_back({part, role->side, part == BodyPart::kMiddle || part == BodyPart::kIndex ? 1 : 0});
  }
  for (const BodyRole& candidate : candidates)
    if (const auto end = followed(candidate); end && *follows_[*end] != *follows_[node]) return end;
  return {};
}

/// Returns the rotation from the avatar's hips at rest to the axes of the motion's: by the line of the hip joints (or
/// the shoulders) and the direction of the neck.
glm::dquat Retargeter::hips_by_frames() const {
  const Index hips = *followed(kHips);
  const auto frame = [](const glm::dvec3& left, const glm::dvec3& up) {
    const glm::dvec3 x = glm::normalize(left);
    const glm::dvec3 z = glm::normalize(glm::cross(x, up));
    return glm::dmat3(x, glm::cross(z, x), z);
  };
  std::optional<Index> top;
  for (const BodyPart part : {BodyPart::kNeck, BodyPart::kHead})
    if (!top) top = followed({part, BodySide::kNone, 0});
  for (const BodyPart part : {BodyPart::kUpperLeg, BodyPart::kUpperArm}) {
    const auto left = followed({part, BodySide::kLeft, 0});
    const auto right = followed({part, BodySide::kRight, 0});
    if (!top || !left || !right) continue;
    const glm::dmat3 source = frame(mean_direction(*follows_[hips], *follows_[*right], *follows_[*left]),
                                    mean_direction(*follows_[hips], *follows_[hips], *follows_[*top]));
    const glm::dmat3 target =
        frame(target_.position[*left] - target_.position[*right], target_.position[*top] - target_.position[hips]);
    const glm::dquat rotation = glm::quat_cast(source * glm::transpose(target));
    if (std::isfinite(glm::length(rotation))) return glm::normalize(rotation);
  }
  throw Error(name_, "its skeleton at rest is no standing person, and hips, neck and legs do not show how it is turned",
              "export it with a T pose as its rest pose");
}

/// Turns every joint as its parent is on average over the motion, and then by the shortest way to its bone's direction.
void Retargeter::align_by_frames() {
  at_rest_.resize(target_.joints.size());
  const Index hips = *followed(kHips);
  // From the avatar's rest to the axes of the joint that the node follows.
  std::vector<glm::dquat> turned(target_.joints.size());
  turned[hips] = hips_by_frames();
  for (Index i = 0; i < target_.joints.size(); ++i) {
    if (follows_[i] && i != hips) {
      Index reference = hips;
      for (int above = target_.joints[i].parent; above >= 0; above = target_.joints[static_cast<Index>(above)].parent)
        if (follows_[static_cast<Index>(above)]) {
          reference = static_cast<Index>(above);
          break;
        }
      turned[i] = mean_turn(*follows_[i], *follows_[reference]) * turned[reference];
      if (const auto end = bone_end(i)) {
        turned[i] = turn(turned[i] * (target_.position[*end] - target_.position[i]),
                         mean_direction(*follows_[i], *follows_[i], *follows_[*end])) *
                    turned[i];
        aligned_.emplace_back(i, *end);
      }
    }
    at_rest_[i] = turned[i] * rest_rotation(i);
  }
}

double Retargeter::ratio_of_legs() const {
  const bool by_height = rests_as_person_;
  const double of_motion = by_height ? hip_height(source_, glm::transpose(body_to_avatar_) * kUp) : leg_length(source_);
  const double of_avatar = by_height ? hip_height(target_, kUp) : leg_length(target_);
  if (of_motion > 0 && of_avatar > 0) return of_avatar / of_motion;
  throw Error(name_, "its hips and feet, or those of the avatar, do not show how tall the body is",
              "give the unit of the motion: --unit cm (or m, mm, inch)");
}

}  // namespace vestige
