#include <algorithm>
#include <array>
#include <glm/common.hpp>
#include <glm/vector_relational.hpp>
#include <vector>

#include "detector/exact/algebraic_time.hpp"
#include "detector/exact/truth.hpp"

namespace vestige::exact {

namespace {

/// The moving point and triangle, seen from the point: then the point rests at the origin.
struct Scene {
  std::array<MovingVector, 3> to_corner;  ///< corner - point

  const MovingVector& from(std::size_t edge) const { return to_corner[edge]; }
  const MovingVector& to(std::size_t edge) const { return to_corner[(edge + 1) % 3]; }
};

Scene scene_of(const Way& way, const Corners& before, const Corners& after) {
  std::array<double, 24> values = {};
  std::size_t next = 0;
  for (const glm::dvec3* point : {&way.start, &way.end, &before.a, &after.a, &before.b, &after.b, &before.c, &after.c})
    for (int axis = 0; axis < 3; ++axis) values[next++] = (*point)[axis];
  const std::array<Whole, 24> whole = whole_multiples(values);
  Scene scene;
  for (std::size_t corner = 0; corner < 3; ++corner) {
    const std::size_t first = 6 * (corner + 1);
    for (std::size_t axis = 0; axis < 3; ++axis)
      scene.to_corner[corner][axis] =
          Polynomial::moving(whole[first + axis] - whole[axis], whole[first + 3 + axis] - whole[3 + axis]);
  }
  return scene;
}

/// cross(corner_i - x, corner_(i+1) - x) for each edge: twice the area, as a vector, of the triangle that the point and
/// the edge span. Their sum is the triangle's own.
std::array<MovingVector, 3> edge_areas(const Scene& scene) {
  return {cross(scene.from(0), scene.to(0)), cross(scene.from(1), scene.to(1)), cross(scene.from(2), scene.to(2))};
}

/// Is the point on the closed triangle at `time`, at which it is in a plane with the three corners?
bool on_triangle(const Scene& scene, const std::array<MovingVector, 3>& area, AlgebraicTime& time) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    // Along an axis in which the triangle is seen with an area, the point's three triangles must all turn as it does.
    const int turn = time.sign_of(area[0][axis] + area[1][axis] + area[2][axis]);
    if (turn == 0) continue;
    return std::ranges::all_of(area, [&](const MovingVector& edge) { return time.sign_of(edge[axis]) * turn >= 0; });
  }
  // No area just then: the triangle is the union of its edges. The point is on one if it is in line with its ends and
  // does not see both in one direction.
  for (std::size_t edge = 0; edge < 3; ++edge) {
    const bool in_line =
        std::ranges::all_of(area[edge], [&](const Polynomial& component) { return time.sign_of(component) == 0; });
    if (in_line && time.sign_of(dot(scene.from(edge), scene.to(edge))) <= 0) return true;
  }
  return false;
}

/// The first time when all move in one plane that turns with them. The time is 0, or else x comes to an edge just then:
/// in line with an edge, or at a corner, and not so throughout. (Were each of those quantities that is zero at the
/// first time zero throughout, then x would be in line with the edge that it is on, throughout; strictly between its
/// ends it would have been on it before; at an end it would have been there always.)
std::optional<AlgebraicTime> first_in_plane(const Scene& scene, const std::array<MovingVector, 3>& area) {
  AlgebraicTime start(0, 0U);
  if (on_triangle(scene, area, start)) return start;
  std::optional<AlgebraicTime> first;
  for (const auto* vectors : {&area, &scene.to_corner})
    for (const MovingVector& vector : *vectors)
      for (const Polynomial& component : vector) {
        if (component.vanishes()) continue;
        for (AlgebraicTime& time : roots_within_frame(component)) {
          if (first && time.compare(*first) >= 0) break;
          if (!on_triangle(scene, area, time)) continue;
          first = time;
          break;
        }
      }
  return first;
}

/// The contract's side: the sign of `height` just before `time`; at 0 the opposite of its sign just after.
int side_at(Polynomial height, AlgebraicTime& time) {
  int before = 1;  // the sign of (earlier - time)^order
  while (!height.vanishes()) {
    const int sign = time.sign_of(height);
    if (sign != 0) return time.is_zero() ? -sign : sign * before;
    height = height.derivative();
    before = -before;
  }
  return 0;
}

/// Whether along some axis the point stays beyond the triangle, wherever in the frame each of them is.
bool apart(const Way& way, const Corners& before, const Corners& after) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto [way_low, way_high] = std::minmax(way.start[axis], way.end[axis]);
    const auto [low, high] =
        std::minmax({before.a[axis], before.b[axis], before.c[axis], after.a[axis], after.b[axis], after.c[axis]});
    if (way_high < low || way_low > high) return true;
  }
  return false;
}

}  // namespace

// Contact needs point and corners in one plane: a root of the cubic dot(normal, x - a). Its roots are isolated by
// Descartes' rule, and each is asked for the signs of quadratics, which tell whether the point is within.
std::optional<FirstContact> ccd_contact(const Way& way, const Corners& before, const Corners& after) {
  if (apart(way, before, after)) return std::nullopt;
  const Scene scene = scene_of(way, before, after);
  const std::array<MovingVector, 3> area = edge_areas(scene);
  // dot(cross(b - a, c - a), x - a) = -dot(a - x, cross(b - x, c - x)).
  const Polynomial height = Polynomial() - dot(scene.to_corner[0], area[1]);
  if (height.vanishes()) {
    std::optional<AlgebraicTime> first = first_in_plane(scene, area);
    if (!first) return std::nullopt;
    return FirstContact{first->rounded(), 0};
  }
  for (AlgebraicTime& time : roots_within_frame(height)) {
    if (!on_triangle(scene, area, time)) continue;
    return FirstContact{time.rounded(), static_cast<std::int8_t>(side_at(height, time))};
  }
  return std::nullopt;
}

}  // namespace vestige::exact
