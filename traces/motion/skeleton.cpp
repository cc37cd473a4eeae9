#include "traces/motion/skeleton.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>

namespace vestige {

namespace {

using Index = std::size_t;

std::optional<glm::dvec3> place_of(const Skeleton& skeleton, BodyPart part, BodySide side) {
  const auto joint = find_role(skeleton, {part, side, 0});
  return joint ? std::optional(skeleton.position[*joint]) : std::nullopt;
}

/// Returns the mean offset of a joint from its parent, in the parent's axes.
glm::dvec3 mean_offset(Index joint, Index parent, const std::vector<std::vector<BvhPlace>>& frames) {
  glm::dvec3 sum(0);
  for (const auto& places : frames)
    sum += glm::conjugate(places[parent].rotation) * (places[joint].position - places[parent].position);
  return sum / static_cast<double>(frames.size());
}

}  // namespace

std::optional<Index> find_role(const Skeleton& skeleton, const BodyRole& role) {
  const auto found = std::ranges::find(skeleton.roles, std::optional(role));
  return found == skeleton.roles.end() ? std::nullopt
                                       : std::optional(static_cast<Index>(found - skeleton.roles.begin()));
}

Skeleton skeleton_of(const BvhMotion& motion, const std::vector<std::vector<BvhPlace>>& frames) {
  // Rounding in the frames must not move the joints of a file whose channels repeat its offsets.
  constexpr double kSameShare = 1e-4;
  Skeleton skeleton;
  for (const BvhJoint& joint : motion.joints) skeleton.joints.push_back({joint.name, joint.parent});
  skeleton.roles = body_roles(skeleton.joints);
  skeleton.usable.assign(skeleton.joints.size(), true);
  const auto hips = find_role(skeleton, kHips);
  std::vector<bool> is_below_hips(motion.joints.size());
  for (Index i = 0; i < motion.joints.size(); ++i) {
    const BvhJoint& joint = motion.joints[i];
    skeleton.position.push_back(joint.offset);
    if (joint.parent < 0) continue;
    const auto parent = static_cast<Index>(joint.parent);
    is_below_hips[i] = hips == parent || is_below_hips[parent];
    const bool has_position =
        std::ranges::any_of(joint.channels, [](BvhChannel channel) { return channel <= BvhChannel::kZPosition; });
    if (is_below_hips[i] && has_position && !frames.empty()) {
      const glm::dvec3 mean = mean_offset(i, parent, frames);
      if (glm::length(mean - joint.offset) > kSameShare * glm::length(mean)) skeleton.position[i] = mean;
    }
    skeleton.position[i] += skeleton.position[parent];
  }
  return skeleton;
}

glm::dquat rotation_of(const glm::dmat4& matrix) {
  glm::dmat3 linear(matrix);
  for (int axis = 0; axis < 3; ++axis)
    if (const double length = glm::length(linear[axis]); length > 0) linear[axis] /= length;
  if (glm::determinant(linear) < 0) linear[0] = -linear[0];
  return glm::normalize(glm::quat_cast(linear));
}

Skeleton skeleton_of(const Avatar& avatar, const std::vector<glm::dmat4>& rest) {
  Skeleton skeleton;
  skeleton.joints = named_joints(avatar);
  const auto roles = body_roles(avatar);
  for (const int index : avatar.node_order) {
    skeleton.roles.push_back(roles[static_cast<Index>(index)]);
    skeleton.position.emplace_back(rest[static_cast<Index>(index)][3]);
    skeleton.usable.push_back(!avatar.nodes[static_cast<Index>(index)].fixed_matrix);
  }
  return skeleton;
}

glm::dvec3 nearest_axis(const glm::dvec3& direction, const glm::dvec3& other, const glm::dvec3& fallback) {
  int best = -1;
  for (int axis = 0; axis < 3; ++axis)
    if (other[axis] == 0 && std::abs(direction[axis]) > (best < 0 ? 0 : std::abs(direction[best]))) best = axis;
  if (best < 0) return fallback;
  glm::dvec3 nearest(0);
  nearest[best] = direction[best] > 0 ? 1 : -1;
  return nearest;
}

glm::dmat3 axes_of(const Skeleton& skeleton) {
  const auto at = [&](BodyPart part, BodySide side) { return place_of(skeleton, part, side); };
  glm::dvec3 upwards(0);
  glm::dvec3 leftwards(0);
  for (const BodyPart part : {BodyPart::kUpperLeg, BodyPart::kUpperArm, BodyPart::kShoulder, BodyPart::kFoot}) {
    const auto left = at(part, BodySide::kLeft);
    const auto right = at(part, BodySide::kRight);
    if (left && right) leftwards += *left - *right;
  }
  for (const BodySide side : {BodySide::kLeft, BodySide::kRight}) {
    const auto foot = at(BodyPart::kFoot, side);
    const auto thigh = at(BodyPart::kUpperLeg, side);
    if (foot && thigh) upwards += *thigh - *foot;
  }
  const auto hips = at(BodyPart::kHips, BodySide::kNone);
  if (const auto head = at(BodyPart::kHead, BodySide::kNone); head && hips) upwards += *head - *hips;
  const glm::dvec3 up = nearest_axis(upwards, glm::dvec3(0), glm::dvec3(0, 1, 0));
  const glm::dvec3 left = nearest_axis(leftwards, up, glm::dvec3(up.x == 0 ? 1 : 0, up.x == 0 ? 0 : 1, 0));
  return {left, up, glm::cross(left, up)};
}

bool is_person(const Skeleton& skeleton, const glm::dmat3& axes) {
  constexpr double kAlong = 0.7;  // cosine of 45 degrees
  const auto points = [&](const std::optional<glm::dvec3>& from, const std::optional<glm::dvec3>& to, int axis) {
    if (!from || !to) return true;
    const glm::dvec3 way = *to - *from;
    return glm::dot(way, axes[axis]) > kAlong * glm::length(way);
  };
  const auto at = [&](BodyPart part, BodySide side) { return place_of(skeleton, part, side); };
  for (const BodySide side : {BodySide::kLeft, BodySide::kRight})
    if (!points(at(BodyPart::kLowerLeg, side), at(BodyPart::kUpperLeg, side), 1) ||
        !points(at(BodyPart::kFoot, side), at(BodyPart::kLowerLeg, side), 1))
      return false;
  if (!points(at(BodyPart::kHips, BodySide::kNone), at(BodyPart::kHead, BodySide::kNone), 1)) return false;
  for (const BodyPart part : {BodyPart::kUpperLeg, BodyPart::kUpperArm})
    if (!points(at(part, BodySide::kRight), at(part, BodySide::kLeft), 0)) return false;
  for (const BodyPart part : {BodyPart::kFoot, BodyPart::kHand}) {
    const auto left = at(part, BodySide::kLeft);
    const auto right = at(part, BodySide::kRight);
    if (left && right && glm::dot(*left - *right, axes[0]) <= 0) return false;
  }
  return true;
}

double hip_height(const Skeleton& skeleton, const glm::dvec3& up) {
  const auto hips = find_role(skeleton, kHips);
  double lowest = std::numeric_limits<double>::infinity();
  for (Index i = 0; i < skeleton.roles.size(); ++i)
    if (skeleton.roles[i] && skeleton.roles[i]->part == BodyPart::kFoot)
      lowest = std::min(lowest, glm::dot(skeleton.position[i], up));
  return hips && std::isfinite(lowest) ? glm::dot(skeleton.position[*hips], up) - lowest : 0;
}

double leg_length(const Skeleton& skeleton) {
  double sum = 0;
  int legs = 0;
  for (const BodySide side : {BodySide::kLeft, BodySide::kRight}) {
    const auto thigh = place_of(skeleton, BodyPart::kUpperLeg, side);
    const auto shin = place_of(skeleton, BodyPart::kLowerLeg, side);
    const auto foot = place_of(skeleton, BodyPart::kFoot, side);
    if (!thigh || !shin || !foot) continue;
    sum += glm::length(*shin - *thigh) + glm::length(*foot - *shin);
    ++legs;
  }
  return legs == 0 ? 0 : sum / legs;
}

glm::dquat turn(const glm::dvec3& from, const glm::dvec3& to) {
  if (!(glm::length(from) > 0) || !(glm::length(to) > 0)) return {1, 0, 0, 0};
  const glm::dvec3 a = glm::normalize(from);
  const glm::dvec3 b = glm::normalize(to);
  const glm::dquat twice(1 + glm::dot(a, b), glm::cross(a, b));
  if (glm::length(twice) > 1e-6) return glm::normalize(twice);
  // Opposite directions: half a turn about any perpendicular axis.
  return glm::angleAxis(glm::pi<double>(),
                        glm::normalize(glm::cross(a, std::abs(a.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0))));
}

}  // namespace vestige
