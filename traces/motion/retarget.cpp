#include "traces/motion/retarget.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "traces/base/error.hpp"
#include "traces/motion/body_roles.hpp"

namespace vestige {

namespace {

using Index = std::size_t;
using Roles = std::vector<std::optional<BodyRole>>;

// The limit of a glTF animation, too: half an hour of 60 joints at 120 Hz. A file may also give only one number a frame
// for all of its joints. So beyond some minutes, at most eight numbers are stored for each number in the file.
constexpr std::size_t kMostNumbers = std::size_t{1} << 26;
constexpr std::size_t kAlwaysAllowed = std::size_t{1} << 22;
constexpr std::size_t kMostGrowth = 8;

constexpr BodyRole kHips = {BodyPart::kHips, BodySide::kNone, 0};

std::optional<Index> find_role(const Roles& roles, const BodyRole& role) {
  const auto found = std::ranges::find(roles, std::optional(role));
  return found == roles.end() ? std::nullopt : std::optional(static_cast<Index>(found - roles.begin()));
}

/// A skeleton at rest, of a motion or an avatar: joints with parents before children.
struct Skeleton {
  std::vector<NamedJoint> joints;
  Roles roles;
  std::vector<glm::dvec3> position;
  std::vector<bool> usable;
};

Skeleton skeleton_of(const BvhMotion& motion) {
  Skeleton skeleton;
  for (const BvhJoint& joint : motion.joints) skeleton.joints.push_back({joint.name, joint.parent});
  for (const BvhPlace& place : bvh_rest(motion)) skeleton.position.push_back(place.position);
  skeleton.roles = body_roles(skeleton.joints);
  skeleton.usable.assign(skeleton.joints.size(), true);
  return skeleton;
}

glm::dquat rotation_of(const glm::dmat4& matrix) {
  glm::dmat3 linear(matrix);
  for (int axis = 0; axis < 3; ++axis)
    if (const double length = glm::length(linear[axis]); length > 0) linear[axis] /= length;
  if (glm::determinant(linear) < 0) linear[0] = -linear[0];
  return glm::normalize(glm::quat_cast(linear));
}

/// Returns the avatar's skeleton; its joints are in the order of `avatar.node_order`.
Skeleton skeleton_of(const Avatar& avatar, const std::vector<glm::dmat4>& rest) {
  Skeleton skeleton;
  std::vector<int> place(avatar.nodes.size(), -1);
  for (const int index : avatar.node_order) {
    const Node& node = avatar.nodes[static_cast<Index>(index)];
    place[static_cast<Index>(index)] = static_cast<int>(skeleton.joints.size());
    skeleton.joints.push_back({node.name, node.parent < 0 ? -1 : place[static_cast<Index>(node.parent)]});
    skeleton.position.emplace_back(rest[static_cast<Index>(index)][3]);
    skeleton.usable.push_back(!node.fixed_matrix);
  }
  skeleton.roles = body_roles(skeleton.joints);
  return skeleton;
}

/// Returns the unit vector of the axis closest to `direction`, perpendicular to `other`.
glm::dvec3 nearest_axis(const glm::dvec3& direction, const glm::dvec3& other, const glm::dvec3& fallback) {
  int best = -1;
  for (int axis = 0; axis < 3; ++axis)
    if (other[axis] == 0 && std::abs(direction[axis]) > (best < 0 ? 0 : std::abs(direction[best]))) best = axis;
  if (best < 0) return fallback;
  glm::dvec3 nearest(0);
  nearest[best] = direction[best] > 0 ? 1 : -1;
  return nearest;
}

/// Returns the directions left, up and forward as columns.
glm::dmat3 axes_of(const Skeleton& skeleton) {
  const auto at = [&](BodyPart part, BodySide side) -> std::optional<glm::dvec3> {
    const auto joint = find_role(skeleton.roles, {part, side, 0});
    return joint ? std::optional(skeleton.position[*joint]) : std::nullopt;
  };
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

/// Returns the height of the hips above the lowest joint of the legs.
double hip_height(const Skeleton& skeleton, const glm::dvec3& up) {
  const auto hips = find_role(skeleton.roles, kHips);
  double lowest = std::numeric_limits<double>::infinity();
  for (Index i = 0; i < skeleton.roles.size(); ++i)
    if (skeleton.roles[i] && skeleton.roles[i]->part == BodyPart::kFoot)
      lowest = std::min(lowest, glm::dot(skeleton.position[i], up));
  return hips && std::isfinite(lowest) ? glm::dot(skeleton.position[*hips], up) - lowest : 0;
}

double height(const BvhMotion& motion, const Skeleton& skeleton, const glm::dvec3& up) {
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -lowest;
  for (Index i = 0; i < skeleton.position.size(); ++i)
    for (const double at : {glm::dot(skeleton.position[i], up), glm::dot(skeleton.position[i] + motion.ends[i], up)}) {
      lowest = std::min(lowest, at);
      highest = std::max(highest, at);
    }
  return highest - lowest;
}

std::string likely_unit(double height) {
  constexpr double kTall_m = 1.7;
  constexpr double kMostFactor = 1.3;
  struct Unit {
    const char* name;
    double metres;
  };
  for (const Unit& unit : {Unit{"m", 1}, {"dm", 0.1}, {"inch", 0.0254}, {"cm", 0.01}, {"mm", 0.001}}) {
    const double ratio = height * unit.metres / kTall_m;
    if (ratio > 1 / kMostFactor && ratio < kMostFactor) return unit.name;
  }
  return {};
}

/// Finds the joint of the motion that each joint of the avatar follows.
class Matcher {
 public:
  Matcher(const Skeleton& motion, const Skeleton& avatar) : motion_(motion), avatar_(avatar) {
    follows_.resize(avatar.joints.size());
    taken_.resize(motion.joints.size());
    match_roles();
    match_spines();
    match_names();
  }
  const std::vector<std::optional<Index>>& follows() const { return follows_; }

 private:
  void match(Index node, Index joint) {
    if (!avatar_.usable[node] || follows_[node]) return;
    follows_[node] = joint;
    taken_[joint] = true;
  }

  void match_roles() {
    for (Index node = 0; node < avatar_.roles.size(); ++node) {
      const auto& role = avatar_.roles[node];
      if (!role || role->part == BodyPart::kSpine) continue;
      if (const auto joint = find_role(motion_.roles, *role)) match(node, *joint);
    }
  }

  static std::vector<Index> spine_of(const Roles& roles) {
    std::map<int, Index> spine;
    for (Index i = 0; i < roles.size(); ++i)
      if (roles[i] && roles[i]->part == BodyPart::kSpine) spine.emplace(roles[i]->segment, i);
    std::vector<Index> joints;
    joints.reserve(spine.size());
    for (const auto& [segment, joint] : spine) joints.push_back(joint);
    return joints;
  }

  /// Matches the upper end of each spine bone with the bone of the other spine that ends there.
  void match_spines() {
    const std::vector<Index> motion = spine_of(motion_.roles);
    const std::vector<Index> avatar = spine_of(avatar_.roles);
    for (Index k = 0; !motion.empty() && k < avatar.size(); ++k)
      match(avatar[k], motion[((k + 1) * motion.size() + avatar.size() - 1) / avatar.size() - 1]);
  }

  /// Matches joints that are no part of a body (tails, skirts) by equal names, if neither has a role.
  void match_names() {
    static const std::set<std::string> anyones = {"", "root", "armature", "scene", "reference"};
    std::map<std::string, Index> by_name;
    for (Index joint = 0; joint < motion_.joints.size(); ++joint)
      if (!taken_[joint]) by_name.emplace(plain_joint_name(motion_.joints[joint].name), joint);
    for (Index node = 0; node < avatar_.joints.size(); ++node) {
      const std::string name = plain_joint_name(avatar_.joints[node].name);
      const auto same = by_name.find(name);
      if (same == by_name.end() || anyones.contains(name)) continue;
      if (!taken_[same->second] && !avatar_.roles[node] && !motion_.roles[same->second]) match(node, same->second);
    }
  }

  const Skeleton& motion_;
  const Skeleton& avatar_;
  std::vector<std::optional<Index>> follows_;
  std::vector<bool> taken_;
};

/// Returns the shortest rotation from one direction to another, or the identity if either has length 0.
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

class Retargeter {
 public:
  Retargeter(const BvhMotion& motion, const Avatar& avatar, const std::string& name)
      : motion_(motion), avatar_(avatar), name_(name), source_(skeleton_of(motion)) {
    world_matrices(avatar, rest_pose(avatar), rest_);
    target_ = skeleton_of(avatar, rest_);
    const glm::dmat3 source_axes = axes_of(source_);
    const glm::dmat3 target_axes = axes_of(target_);
    to_avatar_ = target_axes * glm::transpose(source_axes);
    source_up_ = source_axes[1];
    target_up_ = target_axes[1];
    follows_ = Matcher(source_, target_).follows();
    refuse_other_bodies();
    align();
  }

  void report(RetargetReport& report) const;
  double metres_per_unit(std::optional<double> asked) const;
  Animation animate(double metres_per_unit) const;

 private:
  void refuse_other_bodies() const;
  void refuse_too_many_numbers() const;
  void align();
  glm::dquat flatter(Index foot, const glm::dquat& with_leg) const;
  /// Returns the avatar's joint with this role, if it follows a joint of the motion.
  std::optional<Index> followed(const BodyRole& role) const {
    const auto node = find_role(target_.roles, role);
    return node && follows_[*node] ? node : std::nullopt;
  }
  double reference_height() const;

  const BvhMotion& motion_;
  const Avatar& avatar_;
  const std::string& name_;
  Skeleton source_;
  Skeleton target_;
  std::vector<glm::dmat4> rest_;          ///< world matrices of the avatar's nodes at rest, by node index
  glm::dmat3 to_avatar_ = glm::dmat3(1);  ///< from the motion's axes to the avatar's
  glm::dvec3 source_up_ = glm::dvec3(0, 1, 0);
  glm::dvec3 target_up_ = glm::dvec3(0, 1, 0);
  std::vector<std::optional<Index>> follows_;  ///< for each joint of `target_` one of `source_`
  std::vector<glm::dquat> at_rest_;            ///< for each of `target_`: its rotation while the motion rests
};

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

/// Returns the flatter of two rotations of a foot while the motion rests. Some captures (CMU's) rest with spread legs
/// and feet turned with them, others with feet flat on the floor.
glm::dquat Retargeter::flatter(Index foot, const glm::dquat& with_leg) const {
  constexpr std::size_t kSamples = 64;
  const glm::dquat turn_to_avatar = glm::normalize(glm::quat_cast(to_avatar_));
  const std::size_t step = motion_.frame_count / kSamples + 1;
  double lead = 0;
  std::vector<BvhPlace> places;
  for (std::size_t frame = 0; frame < motion_.frame_count; frame += step) {
    bvh_places(motion_, frame, places);
    const glm::dquat turned = turn_to_avatar * places[*follows_[foot]].rotation * glm::conjugate(turn_to_avatar);
    lead += glm::dot(turned * with_leg * target_up_ - turned * target_up_, target_up_);
  }
  return lead > 0 ? with_leg : glm::dquat(1, 0, 0, 0);
}

/// Turns arms and legs to the direction of the motion's at rest. Hands and fingers turn with their arm, toes with their
/// foot. The trunk is upright in both.
void Retargeter::align() {
  at_rest_.resize(target_.joints.size());
  std::vector<glm::dquat> swing(target_.joints.size(), glm::dquat(1, 0, 0, 0));
  const std::map<BodyPart, BodyPart> next = {{BodyPart::kUpperArm, BodyPart::kLowerArm},
                                             {BodyPart::kLowerArm, BodyPart::kHand},
                                             {BodyPart::kUpperLeg, BodyPart::kLowerLeg},
                                             {BodyPart::kLowerLeg, BodyPart::kFoot}};
  for (Index i = 0; i < target_.joints.size(); ++i) {
    const auto& role = target_.roles[i];
    const int parent = target_.joints[i].parent;
    const bool is_trunk =
        role && (role->side == BodySide::kNone || role->part == BodyPart::kShoulder || role->part == BodyPart::kEye);
    if (parent >= 0 && !is_trunk) swing[i] = swing[static_cast<Index>(parent)];
    if (role && follows_[i] && role->part == BodyPart::kFoot) swing[i] = flatter(i, swing[i]);
    if (role && follows_[i] && next.contains(role->part)) {
      const auto end = followed({next.at(role->part), role->side, 0});
      if (end)
        swing[i] = turn(target_.position[*end] - target_.position[i],
                        to_avatar_ * (source_.position[*follows_[*end]] - source_.position[*follows_[i]]));
    }
    at_rest_[i] = swing[i] * rotation_of(rest_[static_cast<Index>(avatar_.node_order[i])]);
  }
}

void Retargeter::report(RetargetReport& report) const {
  std::vector<std::vector<Index>> followers(source_.joints.size());
  for (Index node = 0; node < follows_.size(); ++node)
    if (follows_[node]) followers[*follows_[node]].push_back(node);
  for (Index joint = 0; joint < followers.size(); ++joint) {
    const std::string& name = source_.joints[joint].name;
    if (followers[joint].empty()) report.unmatched_joints.push_back(name);
    for (const Index node : followers[joint]) {
      const std::string& node_name = target_.joints[node].name;
      const bool same = plain_joint_name(name) == plain_joint_name(node_name);
      report.matched.push_back({name, node_name, same ? JointMatch::How::kName : JointMatch::How::kRole});
    }
  }
  std::set<int> moving;
  for (const PaletteEntry& entry : avatar_.palette) moving.insert(entry.node);
  for (Index node = 0; node < follows_.size(); ++node)
    if (!follows_[node] && moving.contains(avatar_.node_order[node]))
      report.unmatched_nodes.push_back(target_.joints[node].name);
  report.height = height(motion_, source_, source_up_);
  report.likely_unit = likely_unit(report.height);
}

double Retargeter::metres_per_unit(std::optional<double> asked) const {
  if (asked) return *asked;
  const double of_motion = hip_height(source_, source_up_);
  const double of_avatar = hip_height(target_, target_up_);
  if (of_motion > 0 && of_avatar > 0) return of_avatar / of_motion;
  throw Error(name_, "its hips and feet, or those of the avatar, do not show how tall the body is",
              "give the unit of the motion: 'vestige import --motion FILE --unit cm' (or m, or inch)");
}

/// Returns the height of the motion's hips at rest. Some files count it from the floor, others from the rest pose.
double Retargeter::reference_height() const {
  const auto hips = *follows_[*find_role(target_.roles, kHips)];
  std::vector<BvhPlace> places;
  bvh_places(motion_, 0, places);
  const double first = glm::dot(places[hips].position, source_up_);
  const double standing = hip_height(source_, source_up_);
  const double at_rest = glm::dot(source_.position[hips], source_up_);
  double reference = 0;
  for (const double candidate : {standing, at_rest})
    if (std::abs(first - candidate) < std::abs(first - reference)) reference = candidate;
  return reference;
}

/// Counts the numbers that `animate` stores: a time with each rotation, and with the hips' position.
void Retargeter::refuse_too_many_numbers() const {
  const auto followers =
      static_cast<Index>(std::ranges::count_if(follows_, [](const auto& joint) { return joint.has_value(); }));
  const std::size_t numbers = motion_.frame_count * (followers * 5 + 4);
  const std::size_t most = std::min(kMostNumbers, kAlwaysAllowed + kMostGrowth * motion_.values.size());
  if (numbers > most)
    throw Error(
        name_,
        fmt::format("its {} frames become {} numbers for the {} joints of the avatar that follow it, more than {}",
                    motion_.frame_count, numbers, followers, most),
        "cut the motion into parts, or export it with fewer frames a second");
}

Animation Retargeter::animate(double metres_per_unit) const {
  refuse_too_many_numbers();
  Animation animation;
  std::vector<float> times_s;
  for (std::size_t frame = 0; frame < motion_.frame_count; ++frame) {
    times_s.push_back(static_cast<float>(static_cast<double>(frame) * motion_.frame_time_s));
    if (frame > 0 && !(times_s[frame] > times_s[frame - 1]))
      throw Error(name_, fmt::format("the time of frame {} rounds to that of the frame before", frame),
                  "cut the motion into parts");
  }
  const Index hips = *find_role(target_.roles, kHips);
  std::vector<std::optional<Index>> channel_of(target_.joints.size());
  const auto add = [&](Index node, AnimatedProperty property) {
    AnimationChannel channel;
    channel.node = avatar_.node_order[node];
    channel.property = property;
    channel.times_s = times_s;
    channel.values.reserve(motion_.frame_count * (property == AnimatedProperty::kRotation ? 4 : 3));
    animation.channels.push_back(std::move(channel));
    return animation.channels.size() - 1;
  };
  for (Index node = 0; node < follows_.size(); ++node)
    if (follows_[node]) channel_of[node] = add(node, AnimatedProperty::kRotation);
  const Index travel = add(hips, AnimatedProperty::kTranslation);

  const glm::dquat turn_to_avatar = glm::normalize(glm::quat_cast(to_avatar_));
  const glm::dquat turn_back = glm::conjugate(turn_to_avatar);
  const glm::dvec3 hips_at_rest = target_.position[hips];
  const int above_hips = target_.joints[hips].parent;
  const glm::dmat4 into_parent =
      above_hips < 0 ? glm::dmat4(1)
                     : glm::inverse(rest_[static_cast<Index>(avatar_.node_order[static_cast<Index>(above_hips)])]);
  const double reference = reference_height();
  std::vector<BvhPlace> places;
  std::vector<glm::dquat> world(target_.joints.size());
  glm::dvec3 start(0);
  for (std::size_t frame = 0; frame < motion_.frame_count; ++frame) {
    bvh_places(motion_, frame, places);
    for (Index node = 0; node < follows_.size(); ++node) {
      const int parent = target_.joints[node].parent;
      const glm::dquat above = parent < 0 ? glm::dquat(1, 0, 0, 0) : world[static_cast<Index>(parent)];
      if (!follows_[node]) {
        const Node& resting = avatar_.nodes[static_cast<Index>(avatar_.node_order[node])];
        world[node] = resting.fixed_matrix ? above * rotation_of(*resting.fixed_matrix)
                                           : above * glm::normalize(glm::dquat(resting.rest.rotation));
        continue;
      }
      world[node] = turn_to_avatar * places[*follows_[node]].rotation * turn_back * at_rest_[node];
      const glm::quat local(glm::normalize(glm::conjugate(above) * world[node]));
      std::vector<float>& values = animation.channels[*channel_of[node]].values;
      values.insert(values.end(), {local.x, local.y, local.z, local.w});
    }
    const glm::dvec3 position = places[*follows_[hips]].position;
    if (frame == 0) start = position + (reference - glm::dot(position, source_up_)) * source_up_;
    const glm::dvec3 wanted = hips_at_rest + metres_per_unit * (to_avatar_ * (position - start));
    const glm::vec3 local(into_parent * glm::dvec4(wanted, 1));
    std::vector<float>& values = animation.channels[travel].values;
    values.insert(values.end(), {local.x, local.y, local.z});
    if (!std::isfinite(local.x) || !std::isfinite(local.y) || !std::isfinite(local.z))
      throw Error(name_, fmt::format("frame {}: the hips are too far away", frame), "check --unit");
  }
  animation.duration_s = double{times_s.back()};
  return animation;
}

}  // namespace

Animation retarget(const BvhMotion& motion, const Avatar& avatar, std::optional<double> metres_per_unit,
                   const std::string& name, RetargetReport& report) {
  const Retargeter retargeter(motion, avatar, name);
  report = {};
  retargeter.report(report);
  report.metres_per_unit = retargeter.metres_per_unit(metres_per_unit);
  return retargeter.animate(report.metres_per_unit);
}

}  // namespace vestige
