#include "traces/scene/stance.hpp"

#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <numbers>

namespace vestige {

namespace {

/// Returns the rotation about +Y, exact where the angle is half a turn.
glm::dquat rotation_of(const Stance& stance) {
  if (stance.cosine >= 0) {
    const double cosine = std::sqrt((1 + stance.cosine) / 2);
    return {cosine, 0, stance.sine / (2 * cosine), 0};
  }
  const double sine = std::copysign(std::sqrt((1 - stance.cosine) / 2), stance.sine);
  return {stance.sine / (2 * sine), 0, sine, 0};
}

}  // namespace

Stance stance_of(const glm::dvec3& position_m, double yaw_deg, Facing facing) {
  constexpr double kQuarter_deg = 90;
  const double turn_deg = std::remainder(yaw_deg - kQuarter_deg * static_cast<double>(facing), 4 * kQuarter_deg);
  Stance stance = {.position_m = position_m};
  if (std::remainder(turn_deg, kQuarter_deg) == 0) {
    const double quarters = turn_deg / kQuarter_deg;  // -2 to 2
    stance.cosine = quarters == 0 ? 1 : std::abs(quarters) == 2 ? -1 : 0;
    stance.sine = std::abs(quarters) == 1 ? quarters : 0;
    return stance;
  }
  const double turn = turn_deg / 180 * std::numbers::pi;
  stance.cosine = std::cos(turn);
  stance.sine = std::sin(turn);
  return stance;
}

std::string unturnable_root(const Avatar& avatar) {
  for (const Node& node : avatar.nodes)
    if (node.parent < 0 && node.fixed_matrix) return node.name.empty() ? "(without a name)" : node.name;
  return {};
}

void move_to(const Stance& stance, const Avatar& avatar, Pose& pose) {
  pose.origin_m += stance.position_m;
  if (!stance.is_turned()) return;
  const glm::dquat turn = rotation_of(stance);
  for (std::size_t i = 0; i < avatar.nodes.size(); ++i) {
    if (avatar.nodes[i].parent >= 0) continue;
    NodeLocal& root = pose.nodes[i];
    root.translation = stance.turned(root.translation);
    root.rotation = turn * glm::dquat(root.rotation);
  }
}

}  // namespace vestige
