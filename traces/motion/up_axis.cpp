#include "traces/motion/up_axis.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vestige {

namespace {

using Points = std::vector<glm::dvec3>;

/// Returns the body's joints and the ends of its last bones.
Points points_of(const BvhMotion& motion, const std::vector<std::size_t>& body, const std::vector<BvhPlace>& places) {
  Points points;
  for (const std::size_t i : body) {
    points.push_back(places[i].position);
    if (motion.ends[i] != glm::dvec3(0)) points.push_back(places[i].position + places[i].rotation * motion.ends[i]);
  }
  return points;
}

/// Returns the value that this share of all values does not reach.
double quantile(std::vector<double> values, double share) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::ranges::nth_element(values, at);
  return *at;
}

/// Returns the largest extent of the body along an axis of the file.
double size_of(const std::vector<Points>& frames) {
  double size = 0;
  for (const Points& points : frames)
    for (int axis = 0; axis < 3; ++axis) {
      const auto [low, high] = std::ranges::minmax(points, {}, [axis](const glm::dvec3& point) { return point[axis]; });
      size = std::max(size, high[axis] - low[axis]);
    }
  return size;
}

/// Returns how much of a floor the motion has in this direction: from 0, none, to 1.
double floor_evidence(const glm::dvec3& up, const std::vector<Points>& now, const std::vector<Points>& later,
                      double size) {
  // Shares of the body's size: moves that tell something; how deep the floor may lie under zero and over it, where
  // joints are nearer to it than the skin; how much the lowest joint may rise and fall.
  constexpr double kMove = 0.01;
  constexpr double kUnderZero = 0.03;
  constexpr double kOverZero = 0.15;
  constexpr double kUneven = 0.25;
  constexpr double kStillWeight = 0.4;
  constexpr double kEvenWeight = 0.3;
  constexpr double kZeroWeight = 0.3;
  double still = 0;
  double moving = 0;
  std::vector<double> lowest;
  for (std::size_t frame = 0; frame < now.size(); ++frame) {
    std::size_t at = 0;
    double most = 0;
    for (std::size_t i = 0; i < now[frame].size(); ++i) {
      if (glm::dot(now[frame][i], up) < glm::dot(now[frame][at], up)) at = i;
      most = std::max(most, glm::length(later[frame][i] - now[frame][i]));
    }
    lowest.push_back(glm::dot(now[frame][at], up));
    if (most < kMove * size) continue;
    still += 1 - glm::length(later[frame][at] - now[frame][at]) / most;
    moving += 1;
  }
  const double uneven = (quantile(lowest, 0.9) - quantile(lowest, 0.1)) / size;
  const double floor = quantile(lowest, 0.02) / size;
  return kStillWeight * (moving > 0 ? still / moving : 0.5) + kEvenWeight * (1 - std::min(uneven / kUneven, 1.0)) +
         kZeroWeight * (floor > -kUnderZero && floor < kOverZero ? 1 : 0);
}

}  // namespace

MotionSamples sample_motion(const BvhMotion& motion) {
  constexpr std::size_t kMost = 256;
  constexpr double kLater_s = 0.1;
  const auto gap = std::max<std::size_t>(
      1, static_cast<std::size_t>(std::min(kLater_s / motion.frame_time_s, static_cast<double>(motion.frame_count))));
  const std::size_t step = motion.frame_count / kMost + 1;
  MotionSamples samples;
  for (std::size_t frame = 0; frame < motion.frame_count; frame += step) {
    bvh_places(motion, frame, samples.now.emplace_back());
    bvh_places(motion, std::min(frame + gap, motion.frame_count - 1), samples.later.emplace_back());
  }
  return samples;
}

UpAxis find_up(const BvhMotion& motion, const std::vector<std::size_t>& body, const MotionSamples& samples,
               const std::optional<glm::dvec3>& of_rest) {
  // How much more of a floor other directions need than +Y, in the measure of floor_evidence.
  constexpr double kUsual = 0.1;
  constexpr double kUpsideDown = -0.1;
  constexpr double kRest = 0.25;
  constexpr double kClear = 0.05;
  std::vector<Points> now;
  std::vector<Points> later;
  for (const auto& places : samples.now) now.push_back(points_of(motion, body, places));
  for (const auto& places : samples.later) later.push_back(points_of(motion, body, places));
  const double size = size_of(now);
  std::vector<glm::dvec3> candidates = {{0, 1, 0}, {0, 0, 1}, {0, -1, 0}, {0, 0, -1}};
  if (of_rest && std::ranges::find(candidates, *of_rest) == candidates.end()) candidates.push_back(*of_rest);
  double best = -std::numeric_limits<double>::infinity();
  double second = best;
  UpAxis found;
  for (const glm::dvec3& up : candidates) {
    double evidence = size > 0 ? floor_evidence(up, now, later, size) : 0;
    if (up == glm::dvec3(0, 1, 0)) evidence += kUsual;
    if (up.y < 0 || up.z < 0) evidence += kUpsideDown;
    if (of_rest == up) evidence += kRest;
    if (evidence > best) {
      second = best;
      best = evidence;
      found.up = up;
    } else {
      second = std::max(second, evidence);
    }
  }
  const bool is_clear = best - second > kClear;
  if (!is_clear) found.up = of_rest.value_or(glm::dvec3(0, 1, 0));
  found.by = of_rest == found.up ? UpAxis::By::kRest : is_clear ? UpAxis::By::kGround : UpAxis::By::kAssumed;
  return found;
}

double floor_level(const BvhMotion& motion, const std::vector<std::size_t>& body, const MotionSamples& samples,
                   const glm::dvec3& up) {
  constexpr double kShare = 0.02;
  std::vector<double> lowest;
  for (const auto& places : samples.now) {
    double height = std::numeric_limits<double>::infinity();
    for (const glm::dvec3& point : points_of(motion, body, places)) height = std::min(height, glm::dot(point, up));
    lowest.push_back(height);
  }
  return quantile(lowest, kShare);
}

}  // namespace vestige
