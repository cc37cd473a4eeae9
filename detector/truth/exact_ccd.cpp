#include <algorithm>
#include <array>
#include <glm/common.hpp>
#include <glm/vector_relational.hpp>
#include <vector>

#include "detector/truth/algebraic_time.hpp"
#include "detector/truth/moving_points.hpp"
#include "detector/truth/truth.hpp"

namespace vestige::exact {

namespace {

/// The moving point and triangle as differences, from which the contract's formula for the side is built.
struct Scene {
  std::array<MovingVector, 3> edge;         ///< from corner i to corner i + 1
  std::array<MovingVector, 3> from_corner;  ///< from corner i to the point
};

Scene scene_of(const Way& way, const Corners& before, const Corners& after) {
  const MovingPoints points({way, 0}, before, after);
  return {{points.difference(1, 2), points.difference(2, 3), points.difference(3, 1)},
          {points.difference(1, 0), points.difference(2, 0), points.difference(3, 0)}};
}

/// Returns, for each edge, twice the area, as a vector, of the triangle that the point and the edge span.
std::array<MovingVector, 3> edge_areas(const Scene& scene) {
  std::array<MovingVector, 3> areas;
  for (std::size_t i = 0; i < 3; ++i) areas[i] = cross(scene.edge[i], scene.from_corner[i]);
  return areas;
}

/// Returns twice the triangle's own area, as a vector: the triangle's normal.
MovingVector normal_of(const Scene& scene) {
  return cross(scene.edge[2], scene.edge[0]);
}

/// Returns whether the point is on the closed triangle at `time`, at which the point and the three corners must lie in
/// one plane.
bool on_triangle(const Scene& scene, const MovingVector& normal, const std::array<MovingVector, 3>& area,
                 AlgebraicTime& time) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    // Take an axis along which the triangle has an area. The three triangles at the point must all turn in the same
    // direction as the triangle.
    const int turn = time.sign_of(normal[axis]);
    if (turn == 0) continue;
    return std::ranges::all_of(area, [&](const MovingVector& edge) { return time.sign_of(edge[axis]) * turn >= 0; });
  }
  // The triangle has no area at this time, so it is the union of its edges. The point is on an edge if the point is in
  // line with the ends of the edge and between them.
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

/// Returns the first contact if point and triangle move in one plane, which may turn with them. Either the contact is
/// at time 0, or the point x reaches an edge at that time: x gets in line with an edge, or gets to a corner, and was
/// not there throughout. Proof: suppose that each of these quantities that is zero at the first time is zero
/// throughout. Then x is always in line with the edge that it is on. If x is strictly between the ends of the edge, x
/// was on the edge before. If x is at an end, x was there always.
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

/// Returns the contract's side: the sign of `height` just before `time`. At time 0, returns the opposite of the sign
/// just after.
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

/// Returns whether, along some axis, the point stays beyond the triangle at all times of the frame, whatever the time
/// of each.
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

// A contact needs the point and the corners in one plane: a root of the cubic dot(normal, x - a). Descartes' rule
// isolates the roots. At each root, the signs of quadratics tell whether the point is within the triangle.
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
