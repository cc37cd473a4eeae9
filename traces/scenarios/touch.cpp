#include "traces/scenarios/touch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <string>
#include <vector>

#include "traces/base/error.hpp"
#include "traces/body/limbs.hpp"
#include "traces/places/body.hpp"
#include "traces/scene/pose.hpp"
#include "traces/scene/reference_skinning.hpp"

namespace vestige {

namespace {

constexpr double kDuration_s = 4;
constexpr double kKeysPerSecond = 60;
// When the hand is up, and when the first of the pats begins.
constexpr double kRaised_s = 0.45;
constexpr double kPats_s = 0.5;
constexpr double kPat_s = 0.35;
constexpr int kPats = 3;
constexpr double kLowered_s = 2;
// Beside a human being.
constexpr double kLift_m = 0.07;    ///< of the hand above the shoulder, between pats
constexpr double kRise_m = 0.15;    ///< of the place above the own shoulder that bends the hand's way
constexpr double kPress_m = 0.004;  ///< how deep the hand's sphere goes into the shoulder
/// The hand's way takes the arm over within its first 1 / kTaken.
constexpr double kTaken = 5;
/// The share of an arm's length, from shoulder to wrist, at which people stand apart.
constexpr double kReach = 0.85;

std::size_t bone_of(const Avatar& avatar, const char* bone) {
  const auto node = avatar.humanoid.node_of.find(bone);
  if (node == avatar.humanoid.node_of.end())
    throw Error("--colliders touch", fmt::format("the joints of an avatar do not tell its {}", bone),
                "use avatars whose joints have the names of a known program");
  return node->second;
}

glm::dvec3 place_of(const glm::dmat4& matrix) {
  return {matrix[3]};
}

glm::dquat turn_of(const glm::dmat4& matrix) {
  const glm::dmat3 columns(matrix);
  return glm::normalize(
      glm::quat_cast(glm::dmat3(glm::normalize(columns[0]), glm::normalize(columns[1]), glm::normalize(columns[2]))));
}

/// Returns the smallest turn from one direction to another.
glm::dquat turn_between(const glm::dvec3& from, const glm::dvec3& to) {
  const glm::dvec3 a = glm::normalize(from);
  const glm::dvec3 b = glm::normalize(to);
  return glm::normalize(glm::dquat(1 + glm::dot(a, b), glm::cross(a, b)));
}

/// A place of the skin, and from where a hand comes to it, in the scene.
struct Shoulder {
  glm::dvec3 place_m;
  glm::dvec3 outwards;
};

/// Returns the front of the left shoulder, where a vest lies, which a hand pats from above.
Shoulder shoulder_of(const Avatar& avatar, const Stance& stance) {
  const Pose pose = looped_pose(avatar, idle_of(avatar), 0);
  std::vector<glm::dmat4> world;
  world_matrices(avatar, pose, world);
  const glm::dvec3 joint = place_of(world[bone_of(avatar, "LeftUpperArm")]);
  const glm::dvec3 inwards = glm::normalize(place_of(world[bone_of(avatar, "RightUpperArm")]) - joint);
  const double metre = MovingBody(avatar, nullptr).metre();
  std::vector<glm::dvec3> skin;
  skin_reference(avatar, pose, glm::dvec3(0), skin);
  constexpr double kInwards_m = 0.06;
  constexpr double kBelowJoint_m = 0.04;
  constexpr double kAround_m = 0.02;
  constexpr double kThick_m = 0.16;
  const glm::dvec3 middle = joint + metre * (kInwards_m * inwards - glm::dvec3(0, kBelowJoint_m, 0));
  const glm::dvec3 outwards = glm::normalize(glm::cross(glm::dvec3(0, 1, 0), inwards) + glm::dvec3(0, 1, 0));
  glm::dvec3 place = middle;
  for (const glm::dvec3& p : skin) {
    const glm::dvec3 away = p - middle;
    const double height = glm::dot(away, outwards);
    const bool is_there = glm::length(away - height * outwards) < kAround_m * metre && height < kThick_m * metre;
    if (is_there && height > glm::dot(place - middle, outwards)) place = p;
  }
  return {stance.turned(place) + stance.position_m, stance.turned(outwards)};
}

/// The giver's right arm in a pose, in the giver's own frame.
class Arm {
 public:
  explicit Arm(const Avatar& avatar)
      : avatar_(avatar),
        upper_(bone_of(avatar, "RightUpperArm")),
        lower_(bone_of(avatar, "RightLowerArm")),
        hand_(bone_of(avatar, "RightHand")) {
    const std::vector<LimbSphere> spheres = fit_limb(avatar, "hand_right");
    if (spheres.empty())
      throw Error("--colliders touch", "no skin of an avatar moves with its right hand",
                  "use an avatar whose hand has a skin");
    const Pose rest = rest_pose(avatar);
    world_matrices(avatar, rest, world_);
    tip_ = *std::ranges::max_element(spheres, {}, [this](const LimbSphere& sphere) {
      return glm::distance(place_of(world_[hand_]), glm::dvec3(world_[sphere.node] * glm::dvec4(sphere.centre, 1)));
    });
  }

  void pose(const Pose& pose) {
    pose_ = &pose;
    world_matrices(avatar_, pose, world_);
  }

  glm::dvec3 shoulder_m() const { return place_of(world_[upper_]); }
  /// The middle of the sphere at the fingers' end.
  glm::dvec3 hand_m() const { return glm::dvec3(world_[tip_.node] * glm::dvec4(tip_.centre, 1)); }
  /// The radius of that sphere, which the arm brings to its goals.
  double hand_radius_m() const { return tip_.radius_m; }
  double length_m() const { return upper_m() + lower_m(); }

  /// The arm's two rotations, of its upper and its lower bone in their parents' frames.
  using Turns = std::array<glm::quat, 2>;
  Turns as_posed() const { return {pose_->nodes[upper_].rotation, pose_->nodes[lower_].rotation}; }
  std::array<std::size_t, 2> nodes() const { return {upper_, lower_}; }

  /// Returns the turns that bring that sphere to a place, with the elbow down; as near as the arm reaches.
  Turns reach(const glm::dvec3& goal) const {
    const glm::dvec3 shoulder = place_of(world_[upper_]);
    const glm::dvec3 elbow = place_of(world_[lower_]);
    const glm::dvec3 wrist = place_of(world_[hand_]);
    const glm::dvec3 held = hand_m() - wrist;
    glm::dquat first(1, 0, 0, 0);
    glm::dquat second(1, 0, 0, 0);
    constexpr int kSteps = 8;  // the hand turns with the arm: what it holds is where only when the arm is there
    for (int step = 0; step < kSteps; ++step) {
      const glm::dvec3 goal_of_wrist = wrist_for(shoulder, goal - second * (first * held));
      const glm::dvec3 bent = elbow_for(shoulder, goal_of_wrist);
      first = turn_between(elbow - shoulder, bent - shoulder);
      second = turn_between(first * (wrist - elbow), goal_of_wrist - bent);
    }
    const auto parent_turn = [this](std::size_t node) {
      const int parent = avatar_.nodes[node].parent;
      return parent < 0 ? glm::dquat(1, 0, 0, 0) : turn_of(world_[static_cast<std::size_t>(parent)]);
    };
    const glm::dquat upper = glm::inverse(parent_turn(upper_)) * first * turn_of(world_[upper_]);
    const glm::dquat lower = glm::inverse(first * parent_turn(lower_)) * second * first * turn_of(world_[lower_]);
    return {glm::quat(upper), glm::quat(lower)};
  }

 private:
  double upper_m() const { return glm::distance(place_of(world_[upper_]), place_of(world_[lower_])); }
  double lower_m() const { return glm::distance(place_of(world_[lower_]), place_of(world_[hand_])); }

  glm::dvec3 wrist_for(const glm::dvec3& shoulder, const glm::dvec3& goal) const {
    constexpr double kStretched = 0.999;
    const double away = std::min(glm::distance(goal, shoulder), kStretched * length_m());
    return shoulder + away * glm::normalize(goal - shoulder);
  }

  glm::dvec3 elbow_for(const glm::dvec3& shoulder, const glm::dvec3& wrist) const {
    const double away = glm::distance(wrist, shoulder);
    const glm::dvec3 along = (wrist - shoulder) / away;
    const glm::dvec3 down = glm::normalize(glm::dvec3(0, -1, 0) + along.y * along);
    // The law of cosines.
    const double cosine =
        std::clamp((upper_m() * upper_m() + away * away - lower_m() * lower_m()) / (2 * upper_m() * away), -1.0, 1.0);
    return shoulder + upper_m() * (cosine * along + std::sqrt(1 - cosine * cosine) * down);
  }

  const Avatar& avatar_;
  std::size_t upper_;
  std::size_t lower_;
  std::size_t hand_;
  LimbSphere tip_;
  const Pose* pose_ = nullptr;
  std::vector<glm::dmat4> world_;
};

/// Returns a turn between two, the same bits on every machine.
glm::quat blended(const glm::quat& from, const glm::quat& to, float share) {
  const glm::quat near = glm::dot(from, to) < 0 ? -to : to;
  return glm::normalize((1 - share) * from + share * near);
}

/// Returns how far the hand has come on its way to the shoulder, from 0 to 1.
double way(double time_s) {
  constexpr double kEnd_s = kPats_s + kPats * kPat_s;
  if (time_s < kEnd_s) return smooth(std::min(time_s / kRaised_s, 1.0));
  return smooth(std::clamp((kLowered_s - time_s) / (kLowered_s - kEnd_s), 0.0, 1.0));
}

/// Returns how near the hand is to the shoulder, from 0 (lifted) to 1 (pressed).
double pressed(double time_s) {
  const double pat = (time_s - kPats_s) / kPat_s;
  if (pat < 0 || pat > kPats) return 0;
  const double share = pat - std::floor(pat);
  return smooth(std::clamp(2.5 * std::min(share, 1 - share), 0.0, 1.0));
}

}  // namespace

const Animation* idle_of(const Avatar& avatar) {
  const auto idle = std::ranges::find(avatar.animations, "idle", &Animation::name);
  return idle == avatar.animations.end() ? nullptr : &*idle;
}

TouchStances touch_stances(const Avatar& giver, const Avatar& receiver) {
  Arm arm(giver);
  const Pose rest = rest_pose(giver);
  arm.pose(rest);
  const glm::dvec3 apart = on_grid({0, 0, kReach * arm.length_m()});
  constexpr double kTurned_deg = 180;
  return {stance_of(glm::dvec3(0), 0, giver.facing.axis), stance_of(apart, kTurned_deg, receiver.facing.axis)};
}

Animation pat_on_shoulder(const Avatar& giver, const Avatar& receiver, const TouchStances& stances) {
  Arm arm(giver);
  const double metre = MovingBody(giver, nullptr).metre();
  const Shoulder shoulder = shoulder_of(receiver, stances.receiver);
  const Stance& stance = stances.giver;
  const auto in_own_frame = [&stance](const glm::dvec3& p) {
    return glm::dvec3(stance.cosine * p.x - stance.sine * p.z, p.y, stance.cosine * p.z + stance.sine * p.x);
  };
  const Animation* idle = idle_of(giver);
  Animation pat = {.name = "pat", .duration_s = kDuration_s, .channels = {}, .morph = {}};
  const std::array<std::size_t, 2> nodes = arm.nodes();
  if (idle != nullptr)
    std::ranges::copy_if(idle->channels, std::back_inserter(pat.channels), [&](const AnimationChannel& channel) {
      return channel.property != AnimatedProperty::kRotation ||
             std::ranges::find(nodes, static_cast<std::size_t>(channel.node)) == nodes.end();
    });
  std::array<AnimationChannel, 2> bones;
  for (std::size_t i = 0; i < bones.size(); ++i)
    bones[i] = {
        .node = static_cast<int>(nodes[i]), .property = AnimatedProperty::kRotation, .times_s = {}, .values = {}};
  for (int key = 0; key <= static_cast<int>(kDuration_s * kKeysPerSecond); ++key) {
    const double time_s = key / kKeysPerSecond;
    const Pose pose = looped_pose(giver, idle, std::min(time_s, kDuration_s - 1 / kKeysPerSecond));
    arm.pose(pose);
    const double above_m =
        arm.hand_radius_m() - kPress_m * metre + (1 - pressed(time_s)) * (kLift_m + kPress_m) * metre;
    const glm::dvec3 end = in_own_frame(shoulder.place_m + above_m * shoulder.outwards - stance.position_m);
    // Up along the own body first, and then forward: a curve of Bézier, bent by a place above the own shoulder.
    const double share = way(time_s);
    const glm::dvec3 bend = arm.shoulder_m() + glm::dvec3(0, kRise_m * metre, 0);
    const glm::dvec3 goal =
        (1 - share) * (1 - share) * arm.hand_m() + 2 * share * (1 - share) * bend + share * share * end;
    const Arm::Turns reaching = arm.reach(goal);
    const Arm::Turns resting = arm.as_posed();
    for (std::size_t i = 0; i < bones.size(); ++i) {
      const glm::quat turn = blended(resting[i], reaching[i], static_cast<float>(std::min(1.0, kTaken * share)));
      bones[i].times_s.push_back(static_cast<float>(time_s));
      bones[i].values.insert(bones[i].values.end(), {turn.x, turn.y, turn.z, turn.w});
    }
  }
  for (AnimationChannel& bone : bones) pat.channels.push_back(std::move(bone));
  return pat;
}

}  // namespace vestige
