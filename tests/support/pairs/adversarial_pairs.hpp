#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "analysis/stress/loose_triangles.hpp"

namespace vestige::test {

/// Triangles and segments. Every pair of a triangle and a segment is close to the border between a contact and a miss.
struct AdversarialPairs {
  std::vector<LooseTriangle> before;
  std::vector<LooseTriangle> now;
  std::vector<Segment> segments;
};

/// Draws `AdversarialPairs`. The triangles are near-copies, a few ulp apart, of one triangle of any shape, size and
/// place. The segments are aimed at its corners, edges, inside and plane. They end, start, pass, rest or lie exactly
/// there, or within a few ulp.
class AdversarialSource {
 public:
  explicit AdversarialSource(std::uint64_t seed, ColliderShape shape = ColliderShape::kPoints)
      : random_(seed), shape_(shape) {}

  AdversarialPairs draw(std::size_t triangles, std::size_t segments) {
    const auto scale = std::ldexp(1.0F, pick<int>({-140, -60, -20, -7, -7, -7, -7, 0, 0, 20, 38, 40, 42, 44, 60}));
    const float place = scale * pick<float>({0, 0, 0, 1, 100, 10000});
    const glm::vec3 centre = place * any_vector();
    const LooseTriangle shape = any_triangle(centre, scale);
    const glm::vec3 motion = pick<float>({0, 0, 1, 0.01F}) * scale * any_vector();
    const float deformation = pick<float>({0, 0, 1, 0.01F}) * scale;
    LooseTriangle shape_before = shape;
    for (glm::vec3& corner : shape_before) corner += motion + deformation * any_vector();

    AdversarialPairs pairs;
    for (std::size_t i = 0; i < triangles; ++i) {
      pairs.now.push_back(shape);
      pairs.before.push_back(shape_before);
      for (std::size_t corner = 0; corner < 3; ++corner) {
        nudge(pairs.now.back()[corner]);
        nudge(pairs.before.back()[corner]);
      }
    }
    for (std::uint32_t i = 0; i < segments; ++i) {
      // Aims at the position of the triangle at time t, so that moving triangles are hit too.
      const float t = pick<float>({0, 1, 1, 1, unit()});
      LooseTriangle target;
      for (std::size_t corner = 0; corner < 3; ++corner)
        target[corner] = shape_before[corner] + t * (shape[corner] - shape_before[corner]);
      Segment segment = aimed(target, scale);
      segment.column = i;
      nudge(segment.start);
      nudge(segment.end);
      if (shape_ == ColliderShape::kSpheres) make_sphere(segment, target, scale);
      pairs.segments.push_back(segment);
    }
    return pairs;
  }

 private:
  template <typename T>
  T pick(std::initializer_list<T> choices) {
    return choices.begin()[random_() % choices.size()];
  }
  float unit() { return std::uniform_real_distribution<float>(0, 1)(random_); }
  float sign() { return 2 * unit() - 1; }
  glm::vec3 any_vector() {
    glm::vec3 v(sign(), sign(), sign());
    if (random_() % 4 == 0) v[static_cast<int>(random_() % 3)] = 0;
    return v;
  }

  /// Changes nothing, or changes some coordinates by one to three ulp.
  void nudge(glm::vec3& v) {
    if (random_() % 2 == 0) return;
    for (int axis = 0; axis < 3; ++axis) {
      const float towards = pick<float>({-1, 1}) * std::numeric_limits<float>::infinity();
      for (int steps = pick<int>({0, 0, 1, 3}); steps > 0; --steps) v[axis] = std::nextafter(v[axis], towards);
    }
  }

  LooseTriangle any_triangle(const glm::vec3& centre, float scale) {
    LooseTriangle triangle;
    for (glm::vec3& corner : triangle) corner = centre + scale * any_vector();
    switch (random_() % 8) {
      case 0:  // needle
        triangle[2] = triangle[1] + 1e-4F * scale * any_vector();
        break;
      case 1:  // no area, except for rounding
        triangle[2] = triangle[0] + unit() * (triangle[1] - triangle[0]);
        break;
      case 2:
        triangle[2] = triangle[1];
        break;
      case 3:  // along an axis
        for (glm::vec3& corner : triangle) corner.z = centre.z;
        break;
      default:
        break;
    }
    return triangle;
  }

  /// Returns a segment through, to, from, at or beside a point of the triangle.
  Segment aimed(const LooseTriangle& triangle, float scale) {
    const glm::vec3 ab = triangle[1] - triangle[0];
    const glm::vec3 ac = triangle[2] - triangle[0];
    float u = unit();
    float v = unit() * (1 - u);
    switch (random_() % 4) {
      case 0:
        u = pick<float>({0, 1});
        v = 0;
        break;
      case 1:
        v = pick<float>({0, 1 - u});
        break;
      default:
        break;
    }
    const glm::vec3 aim = triangle[0] + u * ab + v * ac;
    glm::vec3 way = scale * pick<float>({1, 1, 0.01F, 1e-5F, 1000, 1000}) * any_vector();
    if (random_() % 4 == 0) way = sign() * ab + sign() * ac;  // in the plane
    switch (random_() % 6) {
      case 0:
        return {0, aim, aim + way};
      case 1:
        return {0, aim - way, aim};
      case 2:
        return {0, aim, aim};
      default:
        return {0, aim - unit() * way, aim + unit() * way};
    }
  }

  /// Gives the segment a radius, and mostly moves it so far that the sphere's surface is where the segment was.
  void make_sphere(Segment& segment, const LooseTriangle& triangle, float scale) {
    segment.radius_m = scale * pick<float>({1e-6F, 0.01F, 0.1F, 1, 3, unit()});
    if (segment.radius_m == 0 || random_() % 4 == 0) return;
    glm::dvec3 out = glm::cross(glm::dvec3(triangle[1] - triangle[0]), glm::dvec3(triangle[2] - triangle[0]));
    if (random_() % 3 == 0) out = glm::dvec3(any_vector());
    const double length = glm::length(out);
    if (!(length > 0)) return;
    const glm::vec3 shift(double{segment.radius_m} / length * out);
    segment.start += shift;
    segment.end += shift;
    nudge(segment.end);
  }

  std::mt19937_64 random_;
  ColliderShape shape_;
};

}  // namespace vestige::test
