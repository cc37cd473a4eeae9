#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "detector/truth/algebraic_time.hpp"
#include "detector/truth/moving_points.hpp"
#include "detector/truth/truth.hpp"
#include "detector/truth/whole_vector.hpp"

namespace vestige::exact {

namespace {

/// numerator / denominator; the denominator is positive.
struct Square {
  Whole numerator;
  Whole denominator = 1;

  int compare(const Square& other) const {
    return sign_of(numerator * other.denominator - other.numerator * denominator);
  }
};

/// Returns the squared distance from the origin to the segment between two points.
Square distance_to_edge(const Vector& from, const Vector& to) {
  const Vector edge = minus(to, from);
  const Whole length = dot(edge, edge);
  const Whole along = -dot(from, edge);
  if (along <= 0) return {dot(from, from)};
  if (along >= length) return {dot(to, to)};
  return {dot(from, from) * length - along * along, length};
}

/// Returns the squared distance from the origin to a triangle, by least squares.
Square distance_to_triangle(const Vector& a, const Vector& b, const Vector& c) {
  const Vector ab = minus(b, a);
  const Vector ac = minus(c, a);
  const Whole ab_ab = dot(ab, ab);
  const Whole ac_ac = dot(ac, ac);
  const Whole ab_ac = dot(ab, ac);
  const Whole gram = ab_ab * ac_ac - ab_ac * ab_ac;
  const Whole on_ab = -dot(a, ab);
  const Whole on_ac = -dot(a, ac);
  const Whole weight_b = on_ab * ac_ac - on_ac * ab_ac;  // times gram
  const Whole weight_c = on_ac * ab_ab - on_ab * ab_ac;
  if (gram > 0 && weight_b >= 0 && weight_c >= 0 && weight_b + weight_c <= gram)
    return {dot(a, a) * gram - weight_b * on_ab - weight_c * on_ac, gram};
  const std::array edges = {distance_to_edge(a, b), distance_to_edge(b, c), distance_to_edge(c, a)};
  return *std::ranges::min_element(edges, [](const Square& x, const Square& y) { return x.compare(y) < 0; });
}

/// Returns the squared distance of a point and a triangle whose coordinates are at `first` and following.
template <std::size_t Count>
Square distance_among(const std::array<Whole, Count>& whole, std::size_t first) {
  const auto point = [&](std::size_t i) -> Vector {
    return {whole[first + 3 * i], whole[first + 3 * i + 1], whole[first + 3 * i + 2]};
  };
  return distance_to_triangle(minus(point(1), point(0)), minus(point(2), point(0)), minus(point(3), point(0)));
}

void put(const Apart& apart, double* values) {
  for (const glm::dvec3* point : {&apart.point, &apart.triangle.a, &apart.triangle.b, &apart.triangle.c})
    for (int axis = 0; axis < 3; ++axis) *values++ = (*point)[axis];
}

/// A vertex, an edge or the face of the moving triangle, by least squares: x - a is approximated by a combination of
/// no, one or two edges from a. The sphere overlaps the part if the residue is at most the radius and the combination
/// lies within the part.
struct Part {
  Polynomial excess;               ///< (squared residue - squared radius) times `size`
  Polynomial size;                 ///< determinant of the edges' Gram matrix; the part exists where it is positive
  std::vector<Polynomial> within;  ///< none may be negative
};

struct SphereScene {
  std::vector<Part> parts;
  Polynomial height;  ///< f
};

Polynomial constant(const Whole& value) {
  return Polynomial::moving(value, value);
}

SphereScene sphere_scene(const MovingSphere& sphere, const Corners& before, const Corners& after) {
  const MovingPoints points(sphere, before, after);
  const Polynomial squared_radius = constant(points.radius() * points.radius());
  SphereScene scene;
  for (std::size_t corner = 1; corner <= 3; ++corner) {
    const MovingVector away = points.difference(corner, 0);
    scene.parts.push_back({dot(away, away) - squared_radius, constant(1), {}});
    const MovingVector edge = points.difference(corner, corner % 3 + 1);
    const Polynomial along = dot(away, edge);
    const Polynomial length = dot(edge, edge);
    scene.parts.push_back(
        {(dot(away, away) - squared_radius) * length - along * along, length, {along, length - along}});
  }
  const MovingVector away = points.difference(1, 0);
  const MovingVector first = points.difference(1, 2);
  const MovingVector second = points.difference(1, 3);
  const Polynomial first_first = dot(first, first);
  const Polynomial second_second = dot(second, second);
  const Polynomial first_second = dot(first, second);
  const Polynomial on_first = dot(away, first);
  const Polynomial on_second = dot(away, second);
  const Polynomial gram = first_first * second_second - first_second * first_second;
  const Polynomial b = on_first * second_second - on_second * first_second;  // the weight of b, times gram
  const Polynomial c = on_second * first_first - on_first * first_second;
  scene.parts.push_back(
      {(dot(away, away) - squared_radius) * gram - b * on_first - c * on_second, gram, {b, c, gram - b - c}});
  scene.height = dot(cross(first, second), away);
  return scene;
}

bool overlaps(const SphereScene& scene, AlgebraicTime& time) {
  return std::ranges::any_of(scene.parts, [&](const Part& part) {
    return time.sign_of(part.size) > 0 && time.sign_of(part.excess) <= 0 &&
           std::ranges::all_of(part.within, [&](const Polynomial& weight) { return time.sign_of(weight) >= 0; });
  });
}

/// Returns the contract's side of a sphere: the sign of `height` at `time`. Where that is 0, the sign just before; at
/// time 0, the opposite of the sign just after.
int sphere_side(Polynomial height, AlgebraicTime& time) {
  const bool at_start = time.is_zero();
  int before = 1;
  for (bool is_first = true; !height.vanishes(); is_first = false) {
    const int sign = time.sign_of(height);
    if (sign != 0) return at_start ? (is_first ? sign : -sign) : sign * before;
    height = height.derivative();
    before = -before;
  }
  return 0;
}

/// Whether the sphere stays beyond the triangle along some axis. The tolerance is far larger than the rounding.
bool stays_apart(const MovingSphere& sphere, const Corners& before, const Corners& after) {
  const double reach = sphere.radius * (1 + 0x1p-40);
  for (int axis = 0; axis < 3; ++axis) {
    const auto [way_low, way_high] = std::minmax(sphere.centre.start[axis], sphere.centre.end[axis]);
    const auto [low, high] =
        std::minmax({before.a[axis], before.b[axis], before.c[axis], after.a[axis], after.b[axis], after.c[axis]});
    if (low - way_high > reach || way_low - high > reach) return true;
  }
  return false;
}

}  // namespace

int compare_distances(const Apart& a, const Apart& b) {
  std::array<double, 24> values = {};
  put(a, values.data());
  put(b, values.data() + 12);
  const std::array<Whole, 24> whole = whole_multiples(values);
  return distance_among(whole, 0).compare(distance_among(whole, 12));
}

int compare_distance(const Apart& a, double length) {
  std::array<double, 13> values = {};
  put(a, values.data());
  values[12] = length;
  const std::array<Whole, 13> whole = whole_multiples(values);
  return distance_among(whole, 0).compare({whole[12] * whole[12]});
}

// Something that overlaps begins to do so at a root of the excess of the part that is met first, or of a weight at
// which the nearest point enters the part, or of a size at which the part comes into being. All of these are tried in
// order.
std::optional<FirstTouch> sphere_contact(const MovingSphere& sphere, const Corners& before, const Corners& after) {
  if (stays_apart(sphere, before, after)) return std::nullopt;
  const SphereScene scene = sphere_scene(sphere, before, after);
  const auto touch_at = [&scene](AlgebraicTime& time) {
    return FirstTouch{time.rounded(), static_cast<std::int8_t>(sphere_side(scene.height, time)), time.is_zero()};
  };
  AlgebraicTime start(0, 0U);
  if (overlaps(scene, start)) return touch_at(start);
  std::optional<AlgebraicTime> first;
  const auto try_roots = [&](const Polynomial& polynomial) {
    if (polynomial.vanishes()) return;
    for (AlgebraicTime& time : roots_within_frame(polynomial)) {
      if (first && time.compare(*first) >= 0) return;
      if (!overlaps(scene, time)) continue;
      first = time;
      return;
    }
  };
  for (const Part& part : scene.parts) {
    try_roots(part.excess);
    try_roots(part.size);
    for (const Polynomial& weight : part.within) try_roots(weight);
  }
  if (!first) return std::nullopt;
  return touch_at(*first);
}

}  // namespace vestige::exact
