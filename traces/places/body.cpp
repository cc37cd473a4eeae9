#include "traces/places/body.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>
#include <utility>

#include "traces/base/error.hpp"
#include "traces/scene/pose.hpp"
#include "traces/scene/radius.hpp"
#include "traces/scene/reference_skinning.hpp"

namespace vestige {

namespace {

constexpr double kGrid = 1048576;  // 2^20 steps a metre
constexpr double kHuman_m = 1.75;
constexpr double kShortestHuman_m = 1;
constexpr double kTallestHuman_m = 2.5;
constexpr double kJump = 0.03;  // fraction of the body's size

}  // namespace

glm::dvec3 on_grid(const glm::dvec3& position_m) {
  return glm::round(position_m * kGrid) / kGrid;
}

Across across(const glm::dvec3& direction) {
  const glm::dvec3 axis = std::abs(direction.y) < 0.7 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
  const glm::dvec3 first = glm::normalize(glm::cross(axis, direction));
  return {first, glm::cross(direction, first)};
}

glm::dvec2 disc_place(std::size_t index, std::size_t count) {
  constexpr double kGoldenAngle = std::numbers::pi * (3 - 2.2360679774997896964);
  const double radius = std::sqrt(static_cast<double>(index) / static_cast<double>(count));
  const double angle = kGoldenAngle * static_cast<double>(index);
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

double smooth(double share) {
  const double s = std::clamp(share, 0.0, 1.0);
  return s * s * (3 - 2 * s);
}

MovingBody::MovingBody(const Avatar& avatar, const Animation* animation) : avatar_(avatar), animation_(animation) {
  std::vector<glm::dvec3> posed;
  skin_reference(avatar, looped_pose(avatar, animation, 0), glm::dvec3(0), posed);
  box_m_ = box_around(posed);
  size_m_ = box_m_.longest_side();
  if (size_m_ > 0 && (size_m_ < kShortestHuman_m || size_m_ > kTallestHuman_m)) metre_ = size_m_ / kHuman_m;

  if (animation == nullptr || !(animation->duration_s > 0)) return;
  loop_s_ = animation->duration_s;
  std::vector<glm::dvec3> last;
  skin_reference(avatar, sample_animation(avatar, *animation, loop_s_), glm::dvec3(0), last);
  double farthest_m = 0;
  for (std::size_t i = 0; i < last.size(); ++i) farthest_m = std::max(farthest_m, glm::distance(last[i], posed[i]));
  ends_elsewhere_ = farthest_m > kJump * size_m_;
}

bool MovingBody::jumps(double time_s) {
  const double from_s = std::exchange(last_s_, time_s);
  return ends_elsewhere_ && std::floor(from_s / loop_s_) != std::floor(time_s / loop_s_);
}

const std::vector<glm::dmat4>& MovingBody::palette(double time_s) {
  const double clamped_s = std::max(time_s, 0.0);
  if (clamped_s != palette_s_) {
    palette_matrices(avatar_, looped_pose(avatar_, animation_, clamped_s), palette_);
    palette_s_ = clamped_s;
  }
  return palette_;
}

float sphere_radius_m(const MovingBody& body, const std::optional<float>& asked_m, double usual_m) {
  const double scaled_m = usual_m * body.metre();
  if (!asked_m && scaled_m > double{kLargestRadius_m})
    throw UsageError("--colliders",
                     fmt::format("the avatar is {:.4g} m long, so its spheres would have a radius of {:.3g} m, and a "
                                 "radius is at most {} m",
                                 body.size_m(), scaled_m, kLargestRadius_m),
                     "take an avatar whose unit is the metre, or give a --radius");
  return asked_m.value_or(static_cast<float>(scaled_m));
}

}  // namespace vestige
