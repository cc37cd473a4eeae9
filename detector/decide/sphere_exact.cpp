#include "detector/decide/sphere_exact.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "detector/algebra/unit_roots.hpp"
#include "detector/decide/relative_triangle.hpp"

namespace vestige {

namespace {

/// The face, an edge or a corner. The sphere touches it where `gap` is zero, if one of `nonzero` is not zero (or there
/// is none), and none of `not_negative` is negative: then the part exists, and the nearest point lies in it. The gap is
/// negative where the sphere's surface is beyond the part.
struct Part {
  Polynomial gap;
  std::vector<Polynomial> nonzero;
  std::vector<Polynomial> not_negative;
};

struct SphereMotion {
  std::vector<Part> parts;
  Polynomial above;  ///< f: positive if the centre is on the front side
};

SphereMotion sphere_motion(const MovingSphere& sphere, const Corners& before, const Corners& after) {
  const auto [corner, radius] = relative_triangle(sphere, before, after);
  const Polynomial squared_radius({Integer(radius * radius)});
  const std::array<PolynomialVector, 3> edge = {corner[1] - corner[0], corner[2] - corner[1], corner[0] - corner[2]};
  const PolynomialVector normal = cross(edge[0], edge[1]);
  SphereMotion motion;
  motion.above = -dot(normal, corner[0]);

  Part face = {motion.above * motion.above - squared_radius * dot(normal, normal), {}, {}};
  face.nonzero.assign(normal.begin(), normal.end());
  for (std::size_t i = 0; i < 3; ++i) face.not_negative.push_back(-dot(cross(normal, edge[i]), corner[i]));
  motion.parts.push_back(std::move(face));
  for (std::size_t i = 0; i < 3; ++i) {
    const PolynomialVector& to = corner[(i + 1) % 3];
    const PolynomialVector moment = cross(corner[i], to);
    Part part = {dot(moment, moment) - squared_radius * dot(edge[i], edge[i]), {}, {}};
    part.nonzero.assign(edge[i].begin(), edge[i].end());
    part.not_negative = {-dot(edge[i], corner[i]), dot(edge[i], to)};
    motion.parts.push_back(std::move(part));
    motion.parts.push_back({dot(corner[i], corner[i]) - squared_radius, {}, {}});
  }
  return motion;
}

/// Returns whether the nearest point lies in a part at a time. `sign_of` returns the sign of a polynomial at that time.
template <typename SignOf>
bool is_nearest(const Part& part, const SignOf& sign_of) {
  const auto is_not_zero = [&](const Polynomial& polynomial) { return sign_of(polynomial) != 0; };
  const auto is_not_negative = [&](const Polynomial& polynomial) { return sign_of(polynomial) >= 0; };
  return (part.nonzero.empty() || std::ranges::any_of(part.nonzero, is_not_zero)) &&
         std::ranges::all_of(part.not_negative, is_not_negative);
}

int sign_at_first(const Polynomial& polynomial) {
  return polynomial.sign_at_0();
}

int sign_at_last(const Polynomial& polynomial) {
  return polynomial.sign_at_1();
}

/// Returns the sign of f at a time above 0, or just before that time if f is zero there.
template <typename SignOf>
int side_at(Polynomial above, const SignOf& sign_of) {
  int direction = 1;
  for (; !above.is_zero(); above = above.derivative(), direction = -direction)
    if (const int sign = sign_of(above); sign != 0) return direction * sign;
  return 0;
}

/// The first root of a part's gap at which the sphere touches that part.
struct PartRoot {
  UnitRoots roots;
  std::size_t root = 0;

  auto sign() const {
    return [this](const Polynomial& polynomial) { return roots.sign_at(root, polynomial); };
  }
};

std::optional<PartRoot> first_touch_of(const Part& part) {
  if (part.gap.is_zero()) return {};
  PartRoot found = {UnitRoots(part.gap)};
  for (; found.root < found.roots.count(); ++found.root)
    if (is_nearest(part, found.sign())) return found;
  return {};
}

}  // namespace

std::optional<FirstTouch> sphere_in_integers(const MovingSphere& sphere, const Corners& before, const Corners& after) {
  const SphereMotion motion = sphere_motion(sphere, before, after);
  const Polynomial& above = motion.above;
  const auto touch = [](float t, int side, bool at_start) {
    return FirstTouch{t, static_cast<std::int8_t>(side), at_start};
  };
  for (const Part& part : motion.parts) {
    if (part.gap.sign_at_0() > 0 || !is_nearest(part, sign_at_first)) continue;
    const int side = above.sign_at_0();
    return touch(0, side != 0 ? side : -above.sign_after_0(), true);
  }
  std::optional<PartRoot> first;
  for (const Part& part : motion.parts) {
    auto found = first_touch_of(part);
    if (found && (!first || found->roots.is_before(found->root, first->roots, first->root))) first = std::move(found);
  }
  if (first) return touch(first->roots.rounded(first->root), side_at(above, first->sign()), false);
  for (const Part& part : motion.parts)
    if (!part.gap.is_zero() && part.gap.sign_at_1() == 0 && is_nearest(part, sign_at_last))
      return touch(1, side_at(above, sign_at_last), false);
  return std::nullopt;
}

}  // namespace vestige
