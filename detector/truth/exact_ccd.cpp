#include <algorithm>
#include <array>
#include <glm/common.hpp>
#include <glm/vector_relational.hpp>
#include <vector>

#include "detector/truth/algebraic_time.hpp"
#include "detector/truth/truth.hpp"

namespace vestige::exact {

namespace {

/// The moving point and triangle by their differences: what the contract's formula for the side is made of.
struct Scene {
  std::array<MovingVector, 3> edge;         ///< from corner i to corner i + 1
  std::array<MovingVector, 3> from_corner;  ///< from corner i to the point
};

Scene scene_of(const Way& way, const Corners& before, const Corners& after) {
  std::array<double, 24> values = {};
  std::size_t next = 0;
  for (const glm::dvec3* point : {&way.start, &way.end, &before.a, &after.a, &before.b, &after.b, &before.c, &after.c})
    for (int axis = 0; axis < 3; ++axis) values[next++] = (*point)[axis];
  const std::array<Whole, 24> whole = whole_multiples(values);
  const auto difference = [&whole](std::size_t from, std::size_t to) {
    MovingVector vector;
    for (std::size_t axis = 0; axis < 3; ++axis)
      vector[axis] = Polynomial::moving(whole[6 * to + axis] - whole[6 * from + axis],
                                        whole[6 * to + 3 + axis] - whole[6 * from + 3 + axis]);
    return vector;
  };
  return {{difference(1, 2), difference(2, 3), difference(3, 1)},
          {difference(1, 0), difference(2, 0), difference(3, 0)}};
}

/// For each edge twice the area, as a vector, of the triangle that the point and the edge span.
std::array<MovingVector, 3> edge_areas(const Scene& scene) {
  std::array<MovingVector, 3> areas;
  for (std::size_t i = 0; i < 3; ++i) areas[i] = cross(scene.edge[i], scene.from_corner[i]);
  return areas;
}

/// Twice the triangle's own area, as a vector: its normal.
MovingVector normal_of(const Scene& scene) {
  return cross(scene.edge[2], scene.edge[0]);
}

/// Is the point on the closed triangle at `time`, at which it is in a plane with the three corners?
bool on_triangle(const Scene& scene, const MovingVector& normal, const std::array<MovingVector, 3>& area,
                 AlgebraicTime& time) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    // Along an axis in which the triangle is seen with an area, the point's three triangles must all turn as it does.
    const int turn = time.sign_of(normal[axis]);
    if (turn == 0) continue;
    return std::ranges::all_of(area, [&](const MovingVector& edge) { return time.sign_of(edge[axis]) * turn >= 0; });
  }
  // No area just then: the triangle is the union of its edges. The point is on one if it is in line with its ends and
  // between them.
  for (std::size_t i = 0; i < 3; ++i) {
    const bool in_line =
        std::ranges::all_of(area[i], [&](const Polynomial& component) { return time.sign_of(component) == 0; });
    if (!in_line) continue;
    const bool is_point =
        std::ranges::all_of(scene.edge[i], [&](const Polynomial& part) { return time.sign_of(part) == 0; });
    const auto at_corner = [&](std::size_t corner) {
      return std::ranges::all_of(scene.from_corner[corner],
                                 [&](const Polynomial& part) { return time.sign_of(part) == 0; });
    };
    if (is_point ? at_corner(i)
                 : time.sign_of(dot(scene.edge[i], scene.from_corner[i])) >= 0 &&
                       time.sign_of(dot(scene.edge[i], scene.from_corner[(i + 1) % 3])) <= 0)
      return true;
  }
  return false;
}

/// The first time when all move in one plane that turns with them. The time is 0, or else x comes to an edge just then:
/// in line with an edge, or at a corner, and not so throughout. (Were each of those quantities that is zero at the
/// first time zero throughout, then x would be in line with the edge that it is on, throughout; strictly between its
/// ends it would have been on it before; at an end it would have been there always.)
std::optional<AlgebraicTime> first_in_plane(const Scene& scene, const MovingVector& normal,
                                            const std::array<MovingVector, 3>& area) {
  AlgebraicTime start(0, 0U);
  if (on_triangle(scene, normal, area, start)) return start;
  std::optional<AlgebraicTime> first;
  for (const auto* vectors : {&area, &scene.from_corner})
    for (const MovingVector& vector : *vectors)
      for (const Polynomial& component : vector) {
        if (component.vanishes()) continue;
        for (AlgebraicTime& time : roots_within_frame(component)) {
          if (first && time.compare(*first) >= 0) break;
          if (!on_triangle(scene, normal, area, time)) continue;
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
  const MovingVector normal = normal_of(scene);
  const Polynomial height = dot(normal, scene.from_corner[0]);
  if (height.vanishes()) {
    std::optional<AlgebraicTime> first = first_in_plane(scene, normal, edge_areas(scene));
    if (!first) return std::nullopt;
    return FirstContact{first->rounded(), 0};
  }
  std::vector<AlgebraicTime> times = roots_within_frame(height);
  if (times.empty()) return std::nullopt;
  const std::array<MovingVector, 3> area = edge_areas(scene);
  for (AlgebraicTime& time : times) {
    if (!on_triangle(scene, normal, area, time)) continue;
    return FirstContact{time.rounded(), static_cast<std::int8_t>(side_at(height, time))};
  }
  return std::nullopt;
}

}  // namespace vestige::exact
