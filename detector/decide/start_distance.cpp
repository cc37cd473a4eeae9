#include "detector/decide/start_distance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "detector/algebra/integer_vector.hpp"
#include "detector/decide/bounded.hpp"

namespace vestige {

namespace {

/// A squared distance, numerator / denominator; the denominator is positive.
struct SquaredDistance {
  Integer numerator;
  Integer denominator;

  /// Returns -1, 0 or 1.
  int compare(const SquaredDistance& other) const {
    return Integer(numerator * other.denominator - other.numerator * denominator).sign();
  }
};

/// Returns the exact squared distance from the origin to the triangle.
SquaredDistance squared_distance(const std::array<IntegerVector, 3>& corner) {
  const IntegerVector normal = cross(minus(corner[1], corner[0]), minus(corner[2], corner[0]));
  bool is_above_face = !is_zero(normal);
  for (std::size_t i = 0; i < 3 && is_above_face; ++i) {
    const IntegerVector inward = cross(normal, minus(corner[(i + 1) % 3], corner[i]));
    is_above_face = dot(inward, corner[i]) <= 0;
  }
  if (is_above_face) {
    const Integer height = dot(normal, corner[0]);
    return {height * height, dot(normal, normal)};
  }
  SquaredDistance least = {dot(corner[0], corner[0]), 1};
  const auto offer = [&least](SquaredDistance other) {
    if (other.compare(least) < 0) least = std::move(other);
  };
  for (std::size_t i = 0; i < 3; ++i) {
    const IntegerVector& from = corner[i];
    const IntegerVector& to = corner[(i + 1) % 3];
    offer({dot(from, from), 1});
    const IntegerVector edge = minus(to, from);
    if (dot(from, edge) >= 0 || dot(to, edge) <= 0) continue;  // the foot is outside the edge, which may have no length
    const IntegerVector moment = cross(from, to);
    offer({dot(moment, moment), dot(edge, edge)});
  }
  return least;
}

/// The coordinates of some points as whole numbers in one unit.
template <std::size_t Points>
std::array<IntegerVector, Points> whole_points(const std::array<glm::dvec3, Points>& points, double radius,
                                               Integer& whole_radius) {
  std::array<double, 3 * Points + 1> values = {};
  for (std::size_t i = 0; i < 3 * Points; ++i) values[i] = points[i / 3][static_cast<int>(i % 3)];
  values[3 * Points] = radius;
  const std::array<Integer, 3 * Points + 1> whole = scaled_integers(values);
  std::array<IntegerVector, Points> result;
  for (std::size_t i = 0; i < 3 * Points; ++i) result[i / 3][i % 3] = whole[i];
  whole_radius = whole[3 * Points];
  return result;
}

bool is_less(const glm::dvec3& p, const glm::dvec3& q) {
  return p.x != q.x ? p.x < q.x : (p.y != q.y ? p.y < q.y : p.z < q.z);
}

}  // namespace

StartDistance::StartDistance(const glm::dvec3& centre, const Corners& triangle) : centre_(centre), triangle_(triangle) {
  const Corners relative = {triangle.a - centre, triangle.b - centre, triangle.c - centre};
  const double reach = reach_of(relative);
  range_ = is_in_range(reach) ? separation_from(relative, reach).range : DistanceRange{0, HUGE_VAL};
}

std::optional<std::array<glm::dvec3, 2>> StartDistance::nearest_edge() const {
  const std::array corner = {triangle_.a, triangle_.b, triangle_.c};
  std::array<glm::dvec3, 3> relative = {};
  for (std::size_t i = 0; i < 3; ++i) relative[i] = corner[i] - centre_;
  const double reach = reach_of({relative[0], relative[1], relative[2]});
  if (!is_in_range(reach)) return {};
  // A product of two differences of corners errs by less than 16 kUnit times the square of twice the reach.
  const double error = 64 * kUnit * reach * reach;
  const auto along = [&](std::size_t from, std::size_t to) {
    return glm::dot(relative[to] - relative[from], -relative[from]);  // of the foot on the edge, as seen from `from`
  };
  for (std::size_t i = 0; i < 3; ++i)
    if (along(i, (i + 1) % 3) < -error && along(i, (i + 2) % 3) < -error) return std::array{corner[i], corner[i]};
  const glm::dvec3 normal = glm::cross(relative[1] - relative[0], relative[2] - relative[0]);
  // Two more factors of twice the reach at most, each with its own rounding.
  const double area_error = 64 * error * reach * reach;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t to = (i + 1) % 3;
    const double outward = glm::dot(glm::cross(relative[to] - relative[i], normal), -relative[i]);
    if (!(along(i, to) > error && along(to, i) > error && outward > area_error)) continue;
    return is_less(corner[i], corner[to]) ? std::array{corner[i], corner[to]} : std::array{corner[to], corner[i]};
  }
  return {};
}

int StartDistance::compare(const StartDistance& a, const StartDistance& b, bool& exact_arithmetic) {
  if (a.range_.high < b.range_.low) return -1;
  if (b.range_.high < a.range_.low) return 1;
  if (a.centre_ == b.centre_) {
    const auto edge = a.nearest_edge();
    if (edge && edge == b.nearest_edge()) return 0;
  }
  exact_arithmetic = true;
  Integer unused;
  const std::array points = whole_points<8>(
      {a.centre_, a.triangle_.a, a.triangle_.b, a.triangle_.c, b.centre_, b.triangle_.a, b.triangle_.b, b.triangle_.c},
      0, unused);
  const auto relative = [&points](std::size_t centre) {
    return std::array{minus(points[centre + 1], points[centre]), minus(points[centre + 2], points[centre]),
                      minus(points[centre + 3], points[centre])};
  };
  return squared_distance(relative(0)).compare(squared_distance(relative(4)));
}

int StartDistance::compare(const StartDistance& a, double radius, bool& exact_arithmetic) {
  if (a.range_.high < radius) return -1;
  if (a.range_.low > radius) return 1;
  exact_arithmetic = true;
  Integer whole_radius;
  const std::array points =
      whole_points<4>({a.centre_, a.triangle_.a, a.triangle_.b, a.triangle_.c}, radius, whole_radius);
  const SquaredDistance distance =
      squared_distance({minus(points[1], points[0]), minus(points[2], points[0]), minus(points[3], points[0])});
  return distance.compare({whole_radius * whole_radius, 1});
}

}  // namespace vestige
