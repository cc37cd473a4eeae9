#include "detector/decide/ccd_filter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <limits>

#include "detector/decide/bounded.hpp"
#include "detector/decide/ccd_formulas.hpp"

namespace vestige {

namespace {

// M is, per axis, the largest absolute coordinate of a corner relative to the point (ccd_formulas.hpp). With every Mi
// in this range, nothing overflows. The loss by underflow (2^-1075 a product, times 2^250 at most) is far below the
// bounds (2^-48 * 2^-750 and more). An axis whose coordinates are all zero is exact.
constexpr double kLeastReach = 0x1p-250;
constexpr double kGreatestReach = 0x1p250;

// The search separates two roots, and decides a near touch, by halving. Few cases that 2^-12 does not decide are
// decided by smaller parts.
constexpr int kMostHalvings = 12;
constexpr int kMostParts = 40;
constexpr int kMostNewtonSteps = 40;

using Verdict = CcdProof::Verdict;

constexpr CcdProof kNone = {Verdict::kNoContact, {}};
constexpr CcdProof kGivenUp = {Verdict::kUnsure, {}};

int proven_sign(double value, double error) {
  return value > error ? 1 : (value < -error ? -1 : 0);
}

Corners as_seen_from(const glm::dvec3& point, const Corners& triangle) {
  return {triangle.a - point, triangle.b - point, triangle.c - point};
}

using Quadratic = QuadraticVector<glm::dvec3>;

/// Returns the sign that a coordinate is proven to have throughout, or 0 if no sign is proven.
int proven_sign(const Quadratic& quadratic, int axis, double error) {
  const double middle = 0.5 * quadratic.twice_middle[axis];
  const double least = std::min({quadratic.first[axis], middle, quadratic.last[axis]});
  const double greatest = std::max({quadratic.first[axis], middle, quadratic.last[axis]});
  return least > error ? 1 : (greatest < -error ? -1 : 0);
}

struct ValueAndSlope {
  double value;
  double slope;
};

/// A cubic on [0, 1] by its Bernstein coefficients.
using Cubic = std::array<double, 4>;

/// De Casteljau's algorithm.
ValueAndSlope evaluate(const Cubic& b, double s) {
  const auto mix = [s](double from, double to) { return from + s * (to - from); };
  const double b01 = mix(b[0], b[1]);
  const double b12 = mix(b[1], b[2]);
  const double b23 = mix(b[2], b[3]);
  const double b012 = mix(b01, b12);
  const double b123 = mix(b12, b23);
  return {mix(b012, b123), 3 * (b123 - b012)};
}

/// Returns an approximate root of the cubic, whose ends have opposite signs: Newton's method, kept between the ends.
double solve(const Cubic& b) {
  double low = 0;
  double high = 1;
  double s = b[0] / (b[0] - b[3]);
  for (int step = 0; step < kMostNewtonSteps; ++step) {
    const auto [value, slope] = evaluate(b, s);
    if (value == 0) break;
    ((value > 0) == (b[0] > 0) ? low : high) = s;
    double next = s - value / slope;
    if (std::abs(next - s) <= 4 * kUnit * s) break;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    s = next;
  }
  return s;
}

class Filter {
 public:
  Filter(const Corners& first, const Corners& last) : first_(first), last_(last) {
    glm::dvec3 reach(0);
    for (const glm::dvec3& corner : {first.a, first.b, first.c, last.a, last.b, last.c})
      reach = glm::max(reach, glm::abs(corner));
    for (int axis = 0; axis < 3; ++axis)
      in_range_ &= reach[axis] == 0 || (reach[axis] >= kLeastReach && reach[axis] <= kGreatestReach);
    area_ = {reach.y * reach.z, reach.z * reach.x, reach.x * reach.y};
    volume_error_ = kVolumeError * (area_.z * reach.z);
  }

  bool in_range() const { return in_range_; }

  /// Returns what happens first between these times. Both are multiples of 2^-kMostHalvings, so 1 - t is exact.
  CcdProof search(double low, double high, int halvings) {
    if (--parts_left_ < 0) return kGivenUp;
    const Corners p = at(low);
    const Corners q = at(high);
    const Quadratic bc = quadratic_cross(p.b, q.b, p.c, q.c);
    const std::array<double, 4> dot = cubic_dot(p.a, q.a, bc);
    const Cubic volume = {-dot[0], -dot[1] / 3, -dot[2] / 3, -dot[3]};
    std::array<int, 4> sign = {};
    for (std::size_t i = 0; i < 4; ++i) sign[i] = proven_sign(volume[i], volume_error_);
    if (sign[0] != 0 && std::ranges::all_of(sign, [&](int other) { return other == sign[0]; })) return kNone;
    if (passes_beside(bc, quadratic_cross(p.c, q.c, p.a, q.a), quadratic_cross(p.a, q.a, p.b, q.b))) return kNone;

    // The signs of the coefficients change once, so there is one root, and it is simple (Descartes' rule of signs).
    const bool one_root = sign[0] * sign[3] < 0 && (sign[1] == sign[0] || sign[2] == sign[3]);
    if (one_root) return decide_root(volume, low, high, sign[0]);
    if (halvings == kMostHalvings) return kGivenUp;
    const double middle = 0.5 * (low + high);
    const CcdProof proof = search(low, middle, halvings + 1);
    return proof.verdict == Verdict::kNoContact ? search(middle, high, halvings + 1) : proof;
  }

 private:
  Corners at(double t) const {
    return {corner_at(first_.a, last_.a, t), corner_at(first_.b, last_.b, t), corner_at(first_.c, last_.c, t)};
  }

  double volume_at(double t) const {
    const Corners corners = at(t);
    return -dot_product(corners.a, cross_product(corners.b, corners.c));
  }

  /// Returns whether the point is outside the triangle whenever it is in the triangle's plane. The point divides the
  /// triangle into three parts. The test succeeds if the areas of two of the parts have opposite signs throughout.
  bool passes_beside(const Quadratic& bc, const Quadratic& ca, const Quadratic& ab) const {
    for (int axis = 0; axis < 3; ++axis) {
      const double error = kAreaError * area_[axis];
      const int first = proven_sign(bc, axis, error);
      const int second = proven_sign(ca, axis, error);
      if (first * second < 0) return true;
      if (first == 0 && second == 0) continue;
      const int third = proven_sign(ab, axis, error);
      if (first * third < 0 || second * third < 0) return true;
    }
    return false;
  }

  /// Decides the one root between these times. Before the root, the volume has the sign `sign_before`.
  CcdProof decide_root(const Cubic& volume, double low, double high, int sign_before) const {
    const double s = solve(volume);
    const double t = low + s * (high - low);
    const double slope = evaluate(volume, s).slope / (high - low);
    const double width = 4 * volume_error_ / std::abs(slope) + 4 * kUnit * t;
    if (!(width < 1)) return kGivenUp;
    const double before = std::max(low, t - width);
    const double after = std::min(high, t + width);
    if (proven_sign(volume_at(before), volume_error_) != sign_before ||
        proven_sign(volume_at(after), volume_error_) != -sign_before)
      return kGivenUp;

    // The root is between `before` and `after`. Corners there differ from those at t by at most 2 M width, so the areas
    // differ by at most 8 Mi Mj width, to first order. The factor 17 covers the terms of higher order.
    const Corners corners = at(t);
    const glm::dvec3 bc = cross_product(corners.b, corners.c);
    const glm::dvec3 ca = cross_product(corners.c, corners.a);
    const glm::dvec3 ab = cross_product(corners.a, corners.b);
    const glm::dvec3 error = (kAreaError + 17 * width) * area_;
    bool inside = false;
    for (int axis = 0; axis < 3; ++axis) {
      const std::array<int, 3> sign = {proven_sign(bc[axis], error[axis]), proven_sign(ca[axis], error[axis]),
                                       proven_sign(ab[axis], error[axis])};
      const auto [least, greatest] = std::ranges::minmax(sign);
      if (least < 0 && greatest > 0) return kNone;
      inside |= least == greatest && least != 0;
    }
    const auto rounded = static_cast<float>(before);
    if (!inside || rounded != static_cast<float>(after)) return kGivenUp;
    return {Verdict::kContact, {rounded, static_cast<std::int8_t>(sign_before)}};
  }

  Corners first_;
  Corners last_;
  glm::dvec3 area_;  ///< for the cross product's coordinate k: Mi Mj
  double volume_error_;
  int parts_left_ = kMostParts;
  bool in_range_ = true;
};

/// Returns whether all corners stay on one side of the point along an axis. The test is exact, because the sign of a
/// difference always is.
bool passes_box(const Corners& first, const Corners& last) {
  const glm::dvec3 least =
      glm::min(glm::min(glm::min(first.a, first.b), first.c), glm::min(glm::min(last.a, last.b), last.c));
  const glm::dvec3 greatest =
      glm::max(glm::max(glm::max(first.a, first.b), first.c), glm::max(glm::max(last.a, last.b), last.c));
  for (int axis = 0; axis < 3; ++axis)
    if (least[axis] > 0 || greatest[axis] < 0) return true;
  return false;
}

}  // namespace

CcdProof filter_ccd(const Way& way, const Corners& before, const Corners& after) {
  const Corners first = as_seen_from(way.start, before);
  const Corners last = as_seen_from(way.end, after);
  if (passes_box(first, last)) return kNone;
  Filter filter(first, last);
  return filter.in_range() ? filter.search(0, 1, 0) : kGivenUp;
}

}  // namespace vestige
