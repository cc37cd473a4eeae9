#pragma once

#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <glm/vec3.hpp>
#include <optional>

namespace vestige::test {

/// The truth about a segment and a triangle, in rational arithmetic, by another way than the detectors': the segment is
/// clipped against the half-spaces of the triangle's prism. Triangles without area are not for it.
using Rational = boost::multiprecision::cpp_rational;
using ExactVector = std::array<Rational, 3>;

inline ExactVector exact(const glm::dvec3& v) {
  return {Rational(v.x), Rational(v.y), Rational(v.z)};
}
inline ExactVector minus(const ExactVector& a, const ExactVector& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Rational dot(const ExactVector& a, const ExactVector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline ExactVector cross(const ExactVector& a, const ExactVector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Keeps of [low, high] where value(0) + t (value(1) - value(0)) >= 0.
inline void clip(const Rational& at_start, const Rational& at_end, Rational& low, Rational& high) {
  const Rational slope = at_end - at_start;
  if (slope == 0) {
    if (at_start < 0) high = low - 1;
  } else if (slope > 0) {
    low = std::max(low, Rational(-at_start / slope));
  } else {
    high = std::min(high, Rational(-at_start / slope));
  }
}

/// The first t in [0, 1] at which the closed segment meets the closed triangle.
inline std::optional<Rational> exact_first_contact(const glm::dvec3& p, const glm::dvec3& q, const glm::dvec3& a,
                                                   const glm::dvec3& b, const glm::dvec3& c) {
  const ExactVector ep = exact(p);
  const ExactVector eq = exact(q);
  const std::array<ExactVector, 3> corner = {exact(a), exact(b), exact(c)};
  const ExactVector normal = cross(minus(corner[1], corner[0]), minus(corner[2], corner[0]));
  Rational low = 0;
  Rational high = 1;
  for (int sign : {1, -1})
    clip(sign * dot(normal, minus(ep, corner[0])), sign * dot(normal, minus(eq, corner[0])), low, high);
  for (std::size_t i = 0; i < 3; ++i) {
    const ExactVector inward = cross(normal, minus(corner[(i + 1) % 3], corner[i]));
    clip(dot(inward, minus(ep, corner[i])), dot(inward, minus(eq, corner[i])), low, high);
  }
  if (low > high) return std::nullopt;
  return low;
}

}  // namespace vestige::test
