#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <numbers>
#include <vector>

#include "analysis/stress/stress_families.hpp"
#include "traces/scene/reference_skinning.hpp"

namespace vestige {

namespace {

constexpr std::size_t kCollidersPerFrame = 64;
constexpr double kReach_m = 0.3;

/// The avatar and the colliders in a frame and in the one before, to be made hostile.
struct Moments {
  TraceFrame before;
  TraceFrame now;
};

/// Changes the poses before colliders are aimed at the skin.
using Disturb = std::function<void(Moments&, Random&)>;

Pose any_pose(const Avatar& avatar, Random& random) {
  const Animation& animation = avatar.animations[random.index(avatar.animations.size())];
  return sample_animation(avatar, animation, random.uniform(0, animation.duration_s));
}

/// A joint of the avatar other than its root.
NodeLocal& any_joint(const Avatar& avatar, Pose& pose, Random& random) {
  for (;;) {
    const int node = avatar.palette[random.index(avatar.palette.size())].node;
    if (node != avatar.root_node) return pose.nodes[static_cast<std::size_t>(node)];
  }
}

/// Lets each collider pass a corner, an edge or the middle of a triangle of the skin halfway, if that place is finite.
void aim(const Avatar& avatar, Moments& moments, std::size_t count, Method method, Random& random) {
  std::vector<glm::dvec3> before;
  std::vector<glm::dvec3> now;
  skin_reference(avatar, moments.before.poses.front(), glm::dvec3(0), before);
  skin_reference(avatar, moments.now.poses.front(), glm::dvec3(0), now);
  for (std::uint32_t id = 0; id < count; ++id) {
    const glm::uvec3& triangle = avatar.triangles[random.index(avatar.triangles.size())];
    const std::size_t kind = random.index(3);
    const glm::dvec3 weights = kind == 0   ? glm::dvec3(1, 0, 0)
                               : kind == 1 ? glm::dvec3(0.5, 0.5, 0)
                                           : glm::dvec3(0.25, 0.25, 0.5);
    const auto point = [&](const std::vector<glm::dvec3>& skin) {
      return weights.x * skin[triangle.x] + weights.y * skin[triangle.y] + weights.z * skin[triangle.z];
    };
    const glm::dvec3 target = method == Method::kCcd ? (point(before) + point(now)) / 2.0 : point(now);
    const glm::dvec3 half = random.uniform(0.01, kReach_m) * random.direction();
    moments.before.colliders.push_back({id, target - half});
    moments.now.colliders.push_back({id, target + half});
  }
}

/// Returns frames made by `FrameBuilder`, each from two moments that `disturb` has changed. `spoil` may change
/// colliders.
StressScene posed_scene(StressOrder order, const Disturb& disturb, const Disturb& spoil) {
  const Avatar& avatar = order.subject->avatar;
  Random random = order.random;
  StressScene scene;
  scene.frames.reserve(order.cases / kCollidersPerFrame + 1);
  for (std::size_t done = 0; done < order.cases;) {
    const std::size_t count = std::min(kCollidersPerFrame, order.cases - done);
    Moments moments;
    moments.before.poses.front() = any_pose(avatar, random);
    moments.now = moments.before;
    moments.now.index = 1;
    moments.now.time_ns = 10'000'000;
    disturb(moments, random);
    aim(avatar, moments, count, order.method, random);
    spoil(moments, random);
    scene.frames.push_back(frame_after(moments.before, moments.now, avatar, count, order.method));
    done += count;
  }
  return scene;
}

void leave(Moments&, Random&) {}

glm::quat turn(double angle_rad, const glm::dvec3& axis) {
  return glm::quat(glm::angleAxis(angle_rad, axis));
}

/// Shrinks a joint and twists it by half a turn. Linear blending pulls the skin around it together, like the paper
/// around a sweet (the candy-wrapper effect).
StressScene collapse(StressOrder order) {
  const auto disturb = [&](Moments& moments, Random& random) {
    NodeLocal& joint = any_joint(order.subject->avatar, moments.now.poses.front(), random);
    joint.rotation = joint.rotation * turn(std::numbers::pi, {0, 1, 0});
    joint.scale = glm::vec3(static_cast<float>(order.magnitude));
  };
  return posed_scene(order, disturb, leave);
}

StressScene spin(StressOrder order) {
  const auto disturb = [&](Moments& moments, Random& random) {
    const auto root = static_cast<std::size_t>(order.subject->avatar.root_node);
    NodeLocal& node = moments.now.poses.front().nodes[root];
    node.rotation = turn(order.magnitude * std::numbers::pi / 180, random.direction()) * node.rotation;
  };
  return posed_scene(order, disturb, leave);
}

StressScene mirrored(StressOrder order) {
  const auto disturb = [&](Moments& moments, Random& random) {
    // At both moments: a mirrored bone stays mirrored.
    Random same = random;
    for (Pose* pose : {&moments.before.poses.front(), &moments.now.poses.front()}) {
      random = same;
      NodeLocal& joint = any_joint(order.subject->avatar, *pose, random);
      for (int axis = 0; axis < static_cast<int>(order.magnitude); ++axis) joint.scale[axis] = -joint.scale[axis];
    }
  };
  return posed_scene(order, disturb, leave);
}

/// Every second collider says that it jumped with the avatar; the others are dragged along.
StressScene teleport(StressOrder order) {
  const auto disturb = [&](Moments& moments, Random& random) {
    const glm::dvec3 jump = random.direction();
    moments.now.poses.front().origin_m += glm::round(order.magnitude * jump);
  };
  const auto spoil = [](Moments& moments, Random&) {
    for (const ColliderSample& collider : moments.now.colliders)
      if (collider.id % 2 == 0) moments.now.teleported.push_back(collider.id);
  };
  return posed_scene(order, disturb, spoil);
}

/// What is not finite, or not in fp32.
enum class Broken { kColliderNan, kColliderInfinite, kColliderHuge, kBoneNan, kBoneInfinite, kBoneHuge };

double broken_value(Broken what) {
  if (what == Broken::kColliderNan || what == Broken::kBoneNan) return std::numeric_limits<double>::quiet_NaN();
  if (what == Broken::kColliderHuge) return 1e39;
  return what == Broken::kBoneHuge ? 3e38 : std::numeric_limits<double>::infinity();
}

StressScene non_finite(StressOrder order) {
  const auto what = static_cast<Broken>(static_cast<int>(order.magnitude));
  const auto spoil = [&](Moments& moments, Random& random) {
    TraceFrame& frame = random.index(2) == 0 ? moments.before : moments.now;
    const auto axis = static_cast<int>(random.index(3));
    if (what == Broken::kColliderNan || what == Broken::kColliderInfinite || what == Broken::kColliderHuge) {
      for (ColliderSample& collider : frame.colliders)
        if (collider.id % 2 == 0) collider.position_m[axis] = broken_value(what);
    } else {
      any_joint(order.subject->avatar, frame.poses.front(), random).translation[axis] =
          static_cast<float>(broken_value(what));
    }
  };
  return posed_scene(order, leave, spoil);
}

constexpr std::array kSizes = {1e-3, 1e-6, 0.0};
constexpr std::array kTurnsInDegrees = {10.0, 90.0, 180.0};
constexpr std::array kJumps_m = {1.0, 1000.0, 1e7};
constexpr std::array kAxes = {1.0, 3.0};
constexpr std::array kBroken = {0.0, 1.0, 2.0, 3.0, 4.0, 5.0};

constexpr StressBody kMannequin = StressBody::kMannequin;
constexpr std::array<StressFamily, 5> kPoseFamilies = {{
    {"non_finite", "", "Colliders and bones without a finite place; they must cause no contact.",
     "0 a collider's NaN, 1 its infinity, 2 its 1e39 m; 3 a bone's NaN, 4 its infinity, 5 its 3e38 m", kBroken,
     kMannequin, non_finite},
    {"collapse", "", "A bone twisted by half a turn and shrunk, so that the skin around it collapses.",
     "scale of the bone", kSizes, kMannequin, collapse},
    {"spin", "", "An avatar that turns fast.", "degrees a frame", kTurnsInDegrees, kMannequin, spin},
    {"teleport", "", "An avatar that jumps; half of the colliders are marked as jumping along, and test nothing.",
     "metres", kJumps_m, kMannequin, teleport},
    {"mirrored", "", "A bone with negative scale, which turns its skin inside out.", "mirrored axes", kAxes, kMannequin,
     mirrored},
}};

}  // namespace

std::span<const StressFamily> pose_families() {
  return kPoseFamilies;
}

}  // namespace vestige
