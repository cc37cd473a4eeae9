#include "traces/places/arm.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <optional>
#include <string>

#include "traces/places/body.hpp"
#include "traces/scene/pose.hpp"

namespace vestige {

namespace {

constexpr double kArmStep_m = 0.005;
constexpr double kArmReach_m = 0.15;  // from the bone to the skin
constexpr double kLeastSine = 0.3;    // sine of the angle to an arm that hangs down, of which no side is the upper one

/// Returns the joints from shoulder to wrist at rest, or nothing if one is not named.
std::optional<std::array<glm::dvec3, 3>> joints_of(const Avatar& avatar, ArmSide side) {
  std::vector<glm::dmat4> world;
  world_matrices(avatar, rest_pose(avatar), world);
  std::array<glm::dvec3, 3> joints;
  std::size_t i = 0;
  for (const char* bone : {"UpperArm", "LowerArm", "Hand"}) {
    const auto node = avatar.humanoid.node_of.find(std::string(side == ArmSide::kLeft ? "Left" : "Right") + bone);
    if (node == avatar.humanoid.node_of.end()) return {};
    joints[i++] = glm::dvec3(world[node->second][3]);
  }
  return joints;
}

/// Returns the way across an arm that leads up, or to the front if the arm hangs down.
glm::dvec3 upwards(const glm::dvec3& along, const glm::dvec3& front) {
  const glm::dvec3 up = glm::dvec3(0, 1, 0) - along.y * along;
  if (glm::length(up) > kLeastSine) return glm::normalize(up);
  return glm::normalize(front - glm::dot(front, along) * along);
}

/// Where a ray leaves the skin last, within a distance.
class SkinRay {
 public:
  explicit SkinRay(const Skin& skin) : skin_(skin) {}

  std::optional<SkinPoint> cast(const glm::dvec3& from, const glm::dvec3& direction, double reach_m) const {
    std::optional<SkinPoint> last;
    double last_m = 0;
    const std::vector<glm::uvec3>& triangles = skin_.avatar().triangles;
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
      const glm::dvec3& a = skin_.rest_m()[triangles[i].x];
      const glm::dvec3 ab = skin_.rest_m()[triangles[i].y] - a;
      const glm::dvec3 ac = skin_.rest_m()[triangles[i].z] - a;
      // Moeller & Trumbore 1997; what it misses at an edge, the next point of the arm makes up for.
      const glm::dvec3 p = glm::cross(direction, ac);
      const double determinant = glm::dot(ab, p);
      if (!(std::abs(determinant) > 0)) continue;
      const glm::dvec3 away = from - a;
      const double u = glm::dot(away, p) / determinant;
      const glm::dvec3 q = glm::cross(away, ab);
      const double v = glm::dot(direction, q) / determinant;
      const double along_m = glm::dot(ac, q) / determinant;
      if (!(u >= 0 && v >= 0 && u + v <= 1 && along_m > last_m && along_m <= reach_m)) continue;
      last_m = along_m;
      last = SkinPoint{i, glm::dvec3(1 - u - v, u, v)};
    }
    return last;
  }

 private:
  const Skin& skin_;
};

}  // namespace

std::vector<SkinPoint> outer_arm(const Skin& skin, ArmSide side) {
  const auto joints = joints_of(skin.avatar(), side);
  if (!joints) return {};
  const double metre = MovingBody(skin.avatar(), nullptr).metre();
  const glm::dvec3 front = forward_of(skin.avatar().facing.axis);
  const SkinRay ray(skin);
  std::vector<SkinPoint> points;
  for (std::size_t bone = 0; bone < 2; ++bone) {
    const glm::dvec3 way = (*joints)[bone + 1] - (*joints)[bone];
    const double length = glm::length(way);
    if (!(length > 0)) continue;
    const glm::dvec3 up = upwards(way / length, front);
    const auto steps = static_cast<std::size_t>(std::ceil(length / (kArmStep_m * metre)));
    for (std::size_t i = 0; i < steps; ++i) {
      const double share = static_cast<double>(i) / static_cast<double>(steps);
      if (const auto point = ray.cast((*joints)[bone] + share * way, up, kArmReach_m * metre)) points.push_back(*point);
    }
  }
  return points;
}

SkinPlace place_along(const Skin& skin, const std::vector<SkinPoint>& points, double share,
                      const std::vector<glm::dmat4>& palette) {
  const double place = std::clamp(share, 0.0, 1.0) * static_cast<double>(points.size() - 1);
  const auto before = static_cast<std::size_t>(place);
  const SkinPlace here = skin.place(points[before], palette);
  if (before + 1 == points.size()) return here;
  const SkinPlace next = skin.place(points[before + 1], palette);
  const double between = place - static_cast<double>(before);
  return {glm::mix(here.position_m, next.position_m, between), glm::mix(here.normal, next.normal, between)};
}

}  // namespace vestige
