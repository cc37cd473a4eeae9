#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "detector/decide/bounded.hpp"
#include "detector/decide/decide_static_exactly.hpp"
#include "detector/decision.hpp"

namespace vestige {

namespace {

/// kTripleError holds if nothing underflows or overflows. With differences up to 2^100 and a permanent from 2^-800 up,
/// underflow adds at most 2^-1075 * 2^101 a term, far below kUnit times the permanent.
constexpr double kLargestDifference = 0x1p100;
constexpr double kSmallestPermanent = 0x1p-800;

Bounded operator-(const Bounded& a, const Bounded& b) {
  const double value = a.value - b.value;
  return {value, (a.error + b.error + std::abs(value) * kUnit) * (1 + 8 * kUnit)};
}

struct Cross {
  glm::dvec3 value;
  glm::dvec3 permanent;
};

Cross cross_of(const glm::dvec3& v, const glm::dvec3& w) {
  const glm::dvec3 size_v = glm::abs(v);
  const glm::dvec3 size_w = glm::abs(w);
  return {cross_product(v, w),
          {size_v.y * size_w.z + size_v.z * size_w.y, size_v.z * size_w.x + size_v.x * size_w.z,
           size_v.x * size_w.y + size_v.y * size_w.x}};
}

Bounded triple(const glm::dvec3& u, const Cross& cross) {
  const double value = dot_product(u, cross.value);
  const double permanent = dot_product(glm::dvec3(glm::abs(u)), cross.permanent);
  const bool without_underflow = permanent >= kSmallestPermanent;
  return {value, without_underflow ? kTripleError * permanent : HUGE_VAL};
}

/// Returns numerator / denominator as fp32, if every number within the errors rounds to the same fp32 number.
std::optional<float> sure_quotient(const Bounded& numerator, const Bounded& denominator) {
  const double quotient = numerator.value / denominator.value;
  const double error =
      ((numerator.error + std::abs(quotient) * denominator.error) / (std::abs(denominator.value) - denominator.error) +
       std::abs(quotient) * (4 * kUnit)) *
      (1 + 16 * kUnit);
  const auto low = static_cast<float>(quotient - error);
  const auto high = static_cast<float>(quotient + error);
  if (low != high) return std::nullopt;
  return std::abs(high);  // 0 < t: if both round to 0, never -0
}

}  // namespace

Decision decide_static(const Way& way, const Corners& triangle) {
  // Relative to the way's start p: corners A, B, C, and the way d. With n the normal (b-a) x (c-a), n.(p-a) = -A.(B x
  // C). n.d is the sum of the volumes of d with the edges, d.(A x B) + d.(B x C) + d.(C x A).
  const glm::dvec3 to_a = difference(triangle.a, way.start);
  const glm::dvec3 to_b = difference(triangle.b, way.start);
  const glm::dvec3 to_c = difference(triangle.c, way.start);
  const glm::dvec3 moved = difference(way.end, way.start);
  const glm::dvec3 largest =
      glm::max(glm::max(glm::abs(to_a), glm::abs(to_b)), glm::max(glm::abs(to_c), glm::abs(moved)));
  if (!(largest.x <= kLargestDifference && largest.y <= kLargestDifference && largest.z <= kLargestDifference))
    return decide_static_exactly(way, triangle);

  const Cross ab = cross_of(to_a, to_b);
  const Cross bc = cross_of(to_b, to_c);
  const Cross ca = cross_of(to_c, to_a);
  const Bounded height_start = triple(to_a, bc);  // depth of p below the plane, times |n|
  const std::array<Bounded, 3> edges = {triple(moved, ab), triple(moved, bc), triple(moved, ca)};
  bool left = false;
  bool right = false;
  bool sure = true;
  for (const Bounded& edge : edges) {
    left = left || edge.surely_positive();
    right = right || edge.surely_negative();
    sure = sure && edge.sure();
  }
  // Two opposite signs prove a miss: the way's line passes beside the triangle. A triangle without area is a line. Its
  // volumes relative to the way's start differ from 0 only if the start is not on that line and the way leaves their
  // common plane. Then they never meet.
  if (left && right) return {};
  const double sum = (edges[0].value + edges[1].value) + edges[2].value;
  const double sum_error =
      (edges[0].error + edges[1].error + edges[2].error +
       (std::abs(edges[0].value) + std::abs(edges[1].value) + std::abs(edges[2].value)) * 2 * kUnit) *
      (1 + 8 * kUnit);
  const Bounded closing = {sum, sum_error};  // the decrease of the depth along d
  const Bounded height_end = height_start - closing;
  if (height_start.surely_positive() && height_end.surely_positive()) return {};
  if (height_start.surely_negative() && height_end.surely_negative()) return {};
  if (!sure || !height_start.sure() || !height_end.sure()) return decide_static_exactly(way, triangle);

  const auto t = sure_quotient(height_start, closing);
  if (!t) return decide_static_exactly(way, triangle);
  const std::int8_t side = closing.value < 0 ? 1 : -1;
  return {FirstContact{*t, side}, false};
}

}  // namespace vestige
