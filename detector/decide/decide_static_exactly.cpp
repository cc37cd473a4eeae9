#include "detector/decide/decide_static_exactly.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "detector/algebra/integer_vector.hpp"
#include "detector/algebra/nearest_float.hpp"

namespace vestige {

namespace {

/// Returns t = numerator / denominator if it lies in [0, 1]. The denominator must not be 0.
std::optional<float> time_of(Integer numerator, Integer denominator) {
  if (denominator < 0) {
    numerator = -numerator;
    denominator = -denominator;
  }
  if (numerator < 0 || numerator > denominator) return std::nullopt;
  return nearest_float(numerator, denominator);
}

/// Returns the earlier of two times, if there is one. Rounding is monotonic: the earliest rounded time is the earliest
/// time, rounded.
std::optional<float> earlier(const std::optional<float>& a, const std::optional<float>& b) {
  if (!a) return b;
  return b ? std::min(*a, *b) : a;
}

/// Returns an axis along which `v` is not zero. `v` must not be zero.
std::size_t axis_of(const IntegerVector& v) {
  return !v[0].is_zero() ? 0 : (!v[1].is_zero() ? 1 : 2);
}

/// Returns the time at which the way p + t d first meets the closed edge u v. `d` or the edge may have no length.
std::optional<float> meets_edge(const IntegerVector& p, const IntegerVector& d, const IntegerVector& u,
                                const IntegerVector& v) {
  const IntegerVector edge = minus(v, u);
  const IntegerVector to_u = minus(u, p);
  const IntegerVector normal = cross(d, edge);
  if (!is_zero(normal)) {
    if (dot(to_u, normal) != 0) return std::nullopt;  // the two lines pass each other
    const std::size_t axis = axis_of(normal);
    const Integer along_edge = cross(to_u, d)[axis];
    const bool on_edge = normal[axis] > 0 ? along_edge >= 0 && along_edge <= normal[axis]
                                          : along_edge <= 0 && along_edge >= normal[axis];
    return on_edge ? time_of(cross(to_u, edge)[axis], normal[axis]) : std::nullopt;
  }
  const IntegerVector to_v = minus(v, p);
  if (!is_zero(cross(to_u, to_v)) || !is_zero(cross(to_u, d)) || !is_zero(cross(to_v, d))) return std::nullopt;
  // The way and the edge are on one line.
  if (dot(to_u, to_v) <= 0) return 0.0F;
  if (is_zero(d)) return std::nullopt;
  return earlier(time_of(dot(to_u, d), dot(d, d)), time_of(dot(to_v, d), dot(d, d)));
}

/// Returns whether p, a point of the triangle's plane, lies in the closed triangle. The triangle's normal must not be
/// zero.
bool inside(const IntegerVector& to_a, const IntegerVector& to_b, const IntegerVector& to_c, std::size_t axis) {
  const std::array<Integer, 3> turn = {cross(to_a, to_b)[axis], cross(to_b, to_c)[axis], cross(to_c, to_a)[axis]};
  return std::ranges::all_of(turn, [](const Integer& x) { return x >= 0; }) ||
         std::ranges::all_of(turn, [](const Integer& x) { return x <= 0; });
}

}  // namespace

Decision decide_static_exactly(const Way& way, const Corners& triangle) {
  const std::array<glm::dvec3, 5> points = {way.start, way.end, triangle.a, triangle.b, triangle.c};
  std::array<double, 15> coordinates = {};
  for (std::size_t i = 0; i < coordinates.size(); ++i) coordinates[i] = points[i / 3][static_cast<int>(i % 3)];
  const std::array<Integer, 15> whole = scaled_integers(coordinates);
  const auto point = [&whole](std::size_t i) -> IntegerVector {
    return {whole[3 * i], whole[3 * i + 1], whole[3 * i + 2]};
  };
  const IntegerVector p = point(0);
  const IntegerVector d = minus(point(1), p);
  const IntegerVector a = point(2);
  const IntegerVector b = point(3);
  const IntegerVector c = point(4);
  const IntegerVector to_a = minus(a, p);
  const IntegerVector to_b = minus(b, p);
  const IntegerVector to_c = minus(c, p);
  const Decision miss = {std::nullopt, true};

  const Integer height_start = dot(to_a, cross(to_b, to_c));  // the names are those of decide_static
  const std::array<Integer, 3> edges = {dot(d, cross(to_a, to_b)), dot(d, cross(to_b, to_c)),
                                        dot(d, cross(to_c, to_a))};
  const Integer closing = edges[0] + edges[1] + edges[2];
  const Integer height_end = height_start - closing;
  if ((height_start > 0 && height_end > 0) || (height_start < 0 && height_end < 0)) return miss;

  if (!closing.is_zero()) {
    const bool left = std::ranges::any_of(edges, [](const Integer& edge) { return edge > 0; });
    const bool right = std::ranges::any_of(edges, [](const Integer& edge) { return edge < 0; });
    const auto t = time_of(height_start, closing);
    if ((left && right) || !t) return miss;
    return {FirstContact{*t, static_cast<std::int8_t>(closing < 0 ? 1 : -1)}, true};
  }

  // The way lies in the triangle's plane, or the triangle has no area.
  const IntegerVector normal = cross(minus(b, a), minus(c, a));
  std::optional<float> t;
  if (!is_zero(normal) && inside(to_a, to_b, to_c, axis_of(normal))) t = 0.0F;
  if (!t) t = earlier(meets_edge(p, d, a, b), earlier(meets_edge(p, d, b, c), meets_edge(p, d, c, a)));
  if (!t) return miss;
  return {FirstContact{*t, 0}, true};
}

}  // namespace vestige
