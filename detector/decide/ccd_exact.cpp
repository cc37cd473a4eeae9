#include "detector/decide/ccd_exact.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include "detector/algebra/unit_roots.hpp"
#include "detector/decide/relative_triangle.hpp"

namespace vestige {

namespace {

/// An edge relative to the point: the cross product and the dot product of its two corners, quadratics in t.
struct Edge {
  PolynomialVector cross;
  Polynomial dot;
};

struct Motion {
  std::array<Edge, 3> edges;
  Polynomial above;  ///< f: positive if the point is on the front side
};

Motion make_motion(const Way& way, const Corners& before, const Corners& after) {
  const std::array<PolynomialVector, 3> corner = relative_triangle({way, 0}, before, after).corner;
  Motion motion;
  for (std::size_t i = 0; i < 3; ++i) {
    const PolynomialVector& from = corner[i];
    const PolynomialVector& to = corner[(i + 1) % 3];
    motion.edges[i] = {cross(from, to), dot(from, to)};
  }
  motion.above = -dot(corner[0], motion.edges[1].cross);
  return motion;
}

/// Returns whether the point is in the closed triangle at a time at which it is in the triangle's plane. `sign_of`
/// returns the sign of a quadratic at that time.
template <typename SignOf>
bool is_inside(const Motion& motion, const SignOf& sign_of) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    bool left = false;
    bool right = false;
    for (const Edge& edge : motion.edges) {
      const int sign = sign_of(edge.cross[axis]);
      left |= sign > 0;
      right |= sign < 0;
    }
    if (left || right) return left != right;
  }
  return std::ranges::any_of(motion.edges, [&](const Edge& edge) { return sign_of(edge.dot) <= 0; });
}

/// Returns whether the point is on the closed edge.
template <typename SignOf>
bool is_on_edge(const Edge& edge, const SignOf& sign_of) {
  return std::ranges::all_of(edge.cross, [&](const Polynomial& part) { return sign_of(part) == 0; }) &&
         sign_of(edge.dot) <= 0;
}

int sign_at_start(const Polynomial& polynomial) {
  return polynomial.sign_at_0();
}

int sign_at_end(const Polynomial& polynomial) {
  return polynomial.sign_at_1();
}

auto signs_at(const UnitRoots& roots, std::size_t root) {
  return [&roots, root](const Polynomial& polynomial) { return roots.sign_at(root, polynomial); };
}

/// Returns the first contact of a point that stays in the triangle's plane and starts outside the triangle. The point
/// enters over an edge, at a root of a function that vanishes if the point is on the edge.
std::optional<FirstContact> coplanar_contact(const Motion& motion) {
  std::optional<FirstContact> first;
  const auto offer = [&first](float t) {
    if (!first || t < first->t) first = FirstContact{t, 0};
  };
  for (const Edge& edge : motion.edges) {
    const auto vanishing = std::ranges::find_if(edge.cross, [](const Polynomial& part) { return !part.is_zero(); });
    const UnitRoots roots(vanishing != edge.cross.end() ? *vanishing : edge.dot);
    for (std::size_t root = 0; root < roots.count(); ++root)
      if (is_on_edge(edge, signs_at(roots, root))) offer(roots.rounded(root));
    if (is_on_edge(edge, sign_at_end)) offer(1);
  }
  return first;
}

}  // namespace

std::optional<FirstContact> ccd_in_integers(const Way& way, const Corners& before, const Corners& after) {
  const Motion motion = make_motion(way, before, after);
  const Polynomial& above = motion.above;
  const auto contact = [](float t, int side) { return FirstContact{t, static_cast<std::int8_t>(side)}; };

  int side = above.sign_after_0();
  if (above.sign_at_0() == 0 && is_inside(motion, sign_at_start)) return contact(0, -side);
  if (above.is_zero()) return coplanar_contact(motion);
  const UnitRoots roots(above);
  for (std::size_t root = 0; root < roots.count(); ++root) {
    if (is_inside(motion, signs_at(roots, root))) return contact(roots.rounded(root), side);
    if (!roots.is_even(root)) side = -side;
  }
  if (above.sign_at_1() == 0 && is_inside(motion, sign_at_end)) return contact(1, side);
  return std::nullopt;
}

}  // namespace vestige
