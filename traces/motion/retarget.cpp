#include "traces/motion/retarget.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "traces/base/error.hpp"
#include "traces/motion/compare_directions.hpp"
#include "traces/motion/joint_matching.hpp"
#include "traces/motion/skeleton.hpp"

namespace vestige {

namespace {

using Index = std::size_t;

// Left hand and right hand must not change sides.
constexpr double kHandTolerance_deg = 90;

// The limit of a glTF animation, too: half an hour of 60 joints at 120 Hz. A file may also give only one number a frame
// for all of its joints. So beyond some minutes, at most eight numbers are stored for each number in the file.
constexpr std::size_t kMostNumbers = std::size_t{1} << 26;
constexpr std::size_t kAlwaysAllowed = std::size_t{1} << 22;
constexpr std::size_t kMostGrowth = 8;

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

class Retargeter {
 public:
  Retargeter(const BvhMotion& motion, const Avatar& avatar, const RetargetOptions& options, const std::string& name)
      : motion_(motion),
        avatar_(avatar),
        name_(name),
        samples_(sample_motion(motion)),
        source_(skeleton_of(motion, samples_.now)) {
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

  void report(RetargetReport& report) const;
  Animation animate() const;
  std::vector<Deviation> deviations(const Animation& animation, bool force) const;

 private:
  void refuse_other_bodies() const;
  void refuse_too_many_numbers() const;
  void find_axes(const std::optional<glm::dvec3>& up);
  void align();
  void align_by_frames();
  glm::dquat hips_by_frames() const;
  std::optional<Index> bone_end(Index node) const;
  glm::dquat mean_turn(Index joint, Index reference) const;
  glm::dvec3 mean_direction(Index joint, Index from, Index to) const;
  glm::dquat flatter(Index foot, const glm::dquat& with_leg) const;
  /// Returns the avatar's joint with this role, if it follows a joint of the motion.
  std::optional<Index> followed(const BodyRole& role) const {
    const auto node = find_role(target_, role);
    return node && follows_[*node] ? node : std::nullopt;
  }
  glm::dquat rest_rotation(Index node) const {
    return rotation_of(rest_[static_cast<Index>(avatar_.node_order[node])]);
  }
  std::vector<Index> body() const;
  double height() const;
  double ratio_of_legs() const;
  double reference_height() const;

  const BvhMotion& motion_;
  const Avatar& avatar_;
  const std::string& name_;
  MotionSamples samples_;
  Skeleton source_;
  Skeleton target_;
  std::vector<glm::dmat4> rest_;               ///< world matrices of the avatar's nodes at rest, by node index
  std::vector<std::optional<Index>> follows_;  ///< for each joint of `target_` one of `source_`
  bool rests_as_person_ = false;
  UpAxis up_;
  glm::dmat3 to_avatar_ = glm::dmat3(1);       ///< from the axes of the motion's world to the avatar's
  glm::dmat3 body_to_avatar_ = glm::dmat3(1);  ///< the same of the skeletons at rest, if the motion's rests as a person
  glm::dvec3 target_up_ = glm::dvec3(0, 1, 0);
  double metres_per_unit_ = 0;
  std::vector<glm::dquat> at_rest_;               ///< for each of `target_`: its rotation while its joint's is zero
  std::vector<std::pair<Index, Index>> aligned_;  ///< bones of `target_` that point where the motion's do
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

/// Finds the axes of the world and of both bodies.
void Retargeter::find_axes(const std::optional<glm::dvec3>& up) {
  const glm::dmat3 source_axes = axes_of(source_);
  const glm::dmat3 target_axes = axes_of(target_);
  target_up_ = target_axes[1];
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
    lead += glm::dot(turned * with_leg * target_up_ - turned * target_up_, target_up_);
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
  report.height = height();
  report.likely_unit = likely_unit(report.height);
  report.up = up_;
  report.metres_per_unit = metres_per_unit_;
}

/// Returns the height of the motion's skeleton: at rest, or the lengths of its bones from the feet to the head.
double Retargeter::height() const {
  if (!rests_as_person_) {
    double sum = leg_length(source_);
    const Index hips = *follows_[*followed(kHips)];
    for (auto i = find_role(source_, {BodyPart::kHead, BodySide::kNone, 0}); i && *i != hips;) {
      const int parent = source_.joints[*i].parent;
      if (parent < 0) break;
      sum += glm::length(source_.position[*i] - source_.position[static_cast<Index>(parent)]);
      i = static_cast<Index>(parent);
    }
    return sum;
  }
  const glm::dvec3 up = glm::transpose(body_to_avatar_) * target_up_;
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -lowest;
  for (Index i = 0; i < source_.position.size(); ++i)
    for (const glm::dvec3& end : {source_.position[i], source_.position[i] + motion_.ends[i]}) {
      lowest = std::min(lowest, glm::dot(end, up));
      highest = std::max(highest, glm::dot(end, up));
    }
  return highest - lowest;
}

double Retargeter::ratio_of_legs() const {
  const bool by_height = rests_as_person_;
  const double of_motion =
      by_height ? hip_height(source_, glm::transpose(body_to_avatar_) * target_up_) : leg_length(source_);
  const double of_avatar = by_height ? hip_height(target_, target_up_) : leg_length(target_);
  if (of_motion > 0 && of_avatar > 0) return of_avatar / of_motion;
  throw Error(name_, "its hips and feet, or those of the avatar, do not show how tall the body is",
              "give the unit of the motion: 'vestige import --motion FILE --unit cm' (or m, or inch)");
}

/// Returns the height of the motion's hips while its body stands as the avatar does at rest. Files count it from the
/// floor or from the rest pose; the floor on which the motion happens says which. If neither fits, the lowest joint is
/// on that floor.
double Retargeter::reference_height() const {
  constexpr double kFits = 0.05;     // share of the height of the hips
  constexpr double kOverZero = 0.2;  // share of it: the lowest joint of a body on a floor at 0
  const Index hips = *followed(kHips);
  const double floor = floor_level(motion_, body(), samples_, up_.up);
  const auto is_zero = [&](double standing) { return floor > -kFits * standing && floor < kOverZero * standing; };
  if (rests_as_person_) {
    const glm::dvec3 up = glm::transpose(body_to_avatar_) * target_up_;
    const double at_rest = glm::dot(source_.position[*follows_[hips]], up);
    double lowest = at_rest;
    for (const Index joint : body())
      lowest = std::min(
          {lowest, glm::dot(source_.position[joint], up), glm::dot(source_.position[joint] + motion_.ends[joint], up)});
    const double standing = at_rest - lowest;
    const double by_floor = floor + standing;
    const auto distance = [&](double candidate) { return std::abs(candidate - by_floor); };
    const double above_zero = distance(at_rest) < distance(standing) ? at_rest : standing;
    if (is_zero(standing)) return above_zero;
    return distance(0) < kFits * standing ? 0 : by_floor;
  }
  double lowest = std::numeric_limits<double>::infinity();
  for (Index node = 0; node < follows_.size(); ++node)
    if (follows_[node] && target_.roles[node]) lowest = std::min(lowest, glm::dot(target_.position[node], target_up_));
  const bool have_legs = leg_length(source_) > 0 && leg_length(target_) > 0;
  const double legs = have_legs ? leg_length(source_) / leg_length(target_) : 1 / metres_per_unit_;
  const double hips_height = glm::dot(target_.position[hips], target_up_);
  const double standing = (hips_height - lowest) * legs;
  return is_zero(standing) && lowest >= 0 ? hips_height * legs : floor + standing;
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

Animation Retargeter::animate() const {
  refuse_too_many_numbers();
  Animation animation;
  std::vector<float> times_s;
  for (std::size_t frame = 0; frame < motion_.frame_count; ++frame) {
    times_s.push_back(static_cast<float>(static_cast<double>(frame) * motion_.frame_time_s));
    if (frame > 0 && !(times_s[frame] > times_s[frame - 1]))
      throw Error(name_, fmt::format("the time of frame {} rounds to that of the frame before", frame),
                  "cut the motion into parts");
  }
  const Index hips = *followed(kHips);
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
  const glm::dquat turn_back = glm::conjugate(glm::normalize(glm::quat_cast(body_to_avatar_)));
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
    if (frame == 0) start = position + (reference - glm::dot(position, up_.up)) * up_.up;
    const glm::dvec3 wanted = hips_at_rest + metres_per_unit_ * (to_avatar_ * (position - start));
    const glm::vec3 local(into_parent * glm::dvec4(wanted, 1));
    std::vector<float>& values = animation.channels[travel].values;
    values.insert(values.end(), {local.x, local.y, local.z});
    if (!std::isfinite(local.x) || !std::isfinite(local.y) || !std::isfinite(local.z))
      throw Error(name_, fmt::format("frame {}: the hips are too far away", frame), "check --unit");
  }
  animation.duration_s = double{times_s.back()};
  return animation;
}

std::vector<Deviation> Retargeter::deviations(const Animation& animation, bool force) const {
  std::vector<ComparedDirection> compared;
  const auto add = [&](Index from, Index to, std::string what, double tolerance_deg) {
    compared.push_back({what.empty() ? fmt::format("{} to {}", shown_word(source_.joints[*follows_[from]].name),
                                                   shown_word(source_.joints[*follows_[to]].name))
                                     : std::move(what),
                        {*follows_[from], *follows_[to]},
                        {static_cast<Index>(avatar_.node_order[from]), static_cast<Index>(avatar_.node_order[to])},
                        tolerance_deg});
  };
  for (const auto& [from, to] : aligned_) add(from, to, "", kBoneTolerance_deg);
  const auto add_pair = [&](BodyPart part, const char* what, double tolerance_deg) {
    const auto left = followed({part, BodySide::kLeft, 0});
    const auto right = followed({part, BodySide::kRight, 0});
    if (left && right) add(*right, *left, what, tolerance_deg);
  };
  add_pair(BodyPart::kUpperLeg, "right hip to left hip", 3 * kBoneTolerance_deg);
  add_pair(BodyPart::kHand, "right hand to left hand", kHandTolerance_deg);
  const auto head = followed({BodyPart::kHead, BodySide::kNone, 0});
  const std::string body = "hips to head";
  if (head) add(*followed(kHips), *head, body, 3 * kBoneTolerance_deg);
  std::vector<Deviation> found = compare_directions(motion_, avatar_, animation, to_avatar_, compared);
  const auto leaning = std::ranges::find(found, body, &Deviation::what);
  if (!force && leaning != found.end() && leaning->degrees > kBodyTolerance_deg)
    throw Error(name_,
                fmt::format("frame {}: from hips to head, the avatar points {:.0f} degrees away from the motion",
                            leaning->frame, leaning->degrees),
                "check the joints that match ('--verbose' names them), or give --force to accept it");
  return found;
}

}  // namespace

Animation retarget(const BvhMotion& motion, const Avatar& avatar, const RetargetOptions& options,
                   const std::string& name, RetargetReport& report) {
  const Retargeter retargeter(motion, avatar, options, name);
  report = {};
  retargeter.report(report);
  Animation animation = retargeter.animate();
  report.deviations = retargeter.deviations(animation, options.force);
  return animation;
}

}  // namespace vestige
