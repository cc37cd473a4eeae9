#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <unordered_map>
#include <vector>

#include "traces/scene/avatar.hpp"
#include "traces/scene/box.hpp"

namespace vestige {

/// Points that cover an avatar's skin, so that every place of it has one within about 2 cm.
class SkinSampler {
 public:
  /// Keeps a reference to the avatar, which must have a triangle.
  explicit SkinSampler(const Avatar& avatar);

  /// Returns the points under a pose, in metres from the world's origin.
  std::vector<glm::dvec3> points_m(const Pose& pose) const;

 private:
  struct Point {
    std::uint32_t triangle;
    glm::dvec3 weight;  ///< of the triangle's corners
  };
  const Avatar& avatar_;
  std::vector<Point> points_;
};

/// Tells whether a place is near any of some points.
class NearPoints {
 public:
  /// What counts as near.
  static constexpr double kNear_m = 0.05;

  /// Precondition: there is a point.
  explicit NearPoints(std::vector<glm::dvec3> points_m);

  bool is_near(const glm::dvec3& place_m) const;
  /// Returns the distance to the nearest point, if it is below `most_m`; otherwise `most_m`.
  double distance_m(const glm::dvec3& place_m, double most_m) const;
  const Box& box() const { return box_; }

 private:
  std::vector<glm::dvec3> points_m_;
  Box box_;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> in_cell_;  ///< indices of points
};

}  // namespace vestige
