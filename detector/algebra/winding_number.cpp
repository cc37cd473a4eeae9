#include "detector/algebra/winding_number.hpp"

#include <array>
#include <cstddef>

#include "detector/algebra/scaled_integers.hpp"

namespace vestige {

namespace {

using Whole = std::array<Integer, 3>;

/// Returns four points as whole numbers in one common unit.
std::array<Whole, 4> whole(const std::array<glm::dvec3, 4>& points) {
  std::array<double, 12> values = {};
  for (std::size_t i = 0; i < 12; ++i) values[i] = points[i / 3][static_cast<int>(i % 3)];
  const auto scaled = scaled_integers(values);
  std::array<Whole, 4> result;
  for (std::size_t i = 0; i < 12; ++i) result[i / 3][i % 3] = scaled[i];
  return result;
}

Whole minus(const Whole& a, const Whole& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

/// Returns the crossing of an edge's projection along x around a point. Both ends are relative to that point.
int crossing(const Whole& from, const Whole& to) {
  const Integer turn = from[1] * to[2] - from[2] * to[1];
  if (from[1] <= 0 && to[1] > 0) return turn > 0 ? 1 : 0;
  if (from[1] > 0 && to[1] <= 0) return turn < 0 ? -1 : 0;
  return 0;
}

}  // namespace

std::optional<int> winding_number(std::span<const glm::vec3> vertices, std::span<const glm::uvec3> triangles,
                                  const glm::vec3& point) {
  int winding = 0;
  for (const glm::uvec3& triangle : triangles) {
    const std::array<glm::vec3, 3> corner = {vertices[triangle.x], vertices[triangle.y], vertices[triangle.z]};
    const auto beside = [&](int axis, int sign) {
      const auto past = [&](const glm::vec3& v) { return sign > 0 ? v[axis] > point[axis] : v[axis] < point[axis]; };
      return past(corner[0]) && past(corner[1]) && past(corner[2]);
    };
    if (beside(0, -1) || beside(1, -1) || beside(1, 1) || beside(2, -1) || beside(2, 1)) continue;
    const auto [p, a, b, c] =
        whole({glm::dvec3(point), glm::dvec3(corner[0]), glm::dvec3(corner[1]), glm::dvec3(corner[2])});
    const Whole pa = minus(a, p);
    const Whole pb = minus(b, p);
    const Whole pc = minus(c, p);
    const Integer volume = pa[0] * (pb[1] * pc[2] - pb[2] * pc[1]) + pa[1] * (pb[2] * pc[0] - pb[0] * pc[2]) +
                           pa[2] * (pb[0] * pc[1] - pb[1] * pc[0]);
    const int around = crossing(pa, pb) + crossing(pb, pc) + crossing(pc, pa);
    if (volume == 0) return std::nullopt;
    // The half-line crosses on the side where volume and projected winding agree.
    if (around > 0 && volume > 0) ++winding;
    if (around < 0 && volume < 0) --winding;
  }
  return winding;
}

}  // namespace vestige
