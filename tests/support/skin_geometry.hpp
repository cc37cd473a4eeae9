#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <vector>

#include "tests/support/small_avatar.hpp"
#include "traces/scene/reference_skinning.hpp"

namespace vestige::test {

/// Returns the outward faces of a box whose corners are numbered by x, then y, then z, each low before high.
inline const std::vector<glm::uvec3>& box_faces() {
  static const std::vector<glm::uvec3> faces = {{0, 1, 3}, {0, 3, 2}, {4, 6, 7}, {4, 7, 5}, {0, 4, 5}, {0, 5, 1},
                                                {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}};
  return faces;
}

/// Returns a closed box of a person's size. Its feet are at the origin, and it faces +z.
inline Avatar box_person(float scale = 1) {
  std::vector<glm::vec3> vertices;
  for (const float x : {-0.25F, 0.25F})
    for (const float y : {0.0F, 1.75F})
      for (const float z : {-0.125F, 0.125F}) vertices.push_back(scale * glm::vec3(x, y, z));
  return rigid_avatar(vertices, box_faces());
}

/// Adds an animation of 2 s: to the avatar's left and forwards, and back.
inline void add_sway(Avatar& avatar, float scale = 1) {
  Animation sway;
  sway.name = "sway";
  sway.duration_s = 2;
  sway.channels.push_back({0,
                           AnimatedProperty::kTranslation,
                           Interpolation::kLinear,
                           {0, 1, 2},
                           {0, 0, 0, 0.3F * scale, 0, 0.2F * scale, 0, 0, 0}});
  avatar.animations.push_back(sway);
}

inline double distance_to_segment(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b) {
  const double squared = glm::dot(b - a, b - a);
  const double share = squared > 0 ? std::clamp(glm::dot(p - a, b - a) / squared, 0.0, 1.0) : 0;
  return glm::distance(p, a + share * (b - a));
}

inline double distance_to_triangle(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const glm::dvec3 normal = glm::cross(b - a, c - a);
  const auto beside = [&](const glm::dvec3& from, const glm::dvec3& to) {
    return glm::dot(glm::cross(normal, to - from), p - from) >= 0;
  };
  if (glm::length(normal) > 0 && beside(a, b) && beside(b, c) && beside(c, a))
    return std::abs(glm::dot(normal, p - a)) / glm::length(normal);
  return std::min({distance_to_segment(p, a, b), distance_to_segment(p, b, c), distance_to_segment(p, c, a)});
}

/// Returns the distance of `p` from the skin, by brute force over all triangles of `avatar` with its vertices at
/// `posed`.
inline double distance_to_skin(const Avatar& avatar, const std::vector<glm::dvec3>& posed, const glm::dvec3& p) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const glm::uvec3& t : avatar.triangles)
    nearest = std::min(nearest, distance_to_triangle(p, posed[t.x], posed[t.y], posed[t.z]));
  return nearest;
}

/// Returns whether a closed skin contains a point, by the solid angles of all triangles (van Oosterom, Strackee 1983).
inline bool is_inside(const Avatar& avatar, const std::vector<glm::dvec3>& posed, const glm::dvec3& p) {
  double half_angles = 0;
  for (const glm::uvec3& t : avatar.triangles) {
    const glm::dvec3 a = posed[t.x] - p;
    const glm::dvec3 b = posed[t.y] - p;
    const glm::dvec3 c = posed[t.z] - p;
    const double la = glm::length(a);
    const double lb = glm::length(b);
    const double lc = glm::length(c);
    half_angles += std::atan2(glm::dot(a, glm::cross(b, c)),
                              la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
  }
  return std::abs(half_angles) > std::numbers::pi;
}

inline std::vector<glm::dvec3> posed_at(const Avatar& avatar, const Animation* animation, double time_s) {
  std::vector<glm::dvec3> posed;
  skin_reference(avatar, looped_pose(avatar, animation, time_s), glm::dvec3(0), posed);
  return posed;
}

}  // namespace vestige::test
