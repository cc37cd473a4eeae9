#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

namespace vestige {

/// Where a segment first meets a triangle. t in [0, 1]; side: +1 through the front (the side from which the corners run
/// counter-clockwise), -1 through the back, 0 coplanar.
struct SegmentHit {
  double t = 0;
  int side = 0;
};

/// The closed segment p q against the closed triangle a b c, touching and coplanar included, by the signs of signed
/// volumes in double. The volume of an edge shared by two triangles has the same magnitude from both, so no segment
/// slips between them sideways (after Woop, Benthin, Wald 2013, "Watertight Ray/Triangle Intersection", JCGT 2(1)).
/// Each volume is rounded: within about 1e-15 of a border, relative, the answer may be wrong.
std::optional<SegmentHit> segment_triangle(const glm::dvec3& p, const glm::dvec3& q, const glm::dvec3& a,
                                           const glm::dvec3& b, const glm::dvec3& c);

/// u, v: the weights of b and c in the point of triangle a b c nearest to `x` in its plane, clamped to the triangle. A
/// triangle without area gives the nearest point of its longest edge. One function for every detector (contract, 7).
glm::dvec2 barycentric_of(const glm::dvec3& x, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c);

}  // namespace vestige
