#include "detector/broad/start_bounds.hpp"

#include <algorithm>
#include <bit>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detector/broad/start_bounds.cpp"  // NOLINT(bugprone-suspicious-include)
#include <hwy/foreach_target.h>
// After foreach_target.h, which includes this file once for each instruction set.
#include <hwy/highway.h>

#include "detector/broad/mask_bits-inl.hpp"

// A difference of two numbers errs by at most u = 2^-24 of itself. Its square and the sum of three squares err by at
// most (1 + u)^5 - 1 < 2^-21 of themselves, and by less than 2^-140 where squares are denormal. 2^-20 and 2^-120 cover
// that and their own rounding.
HWY_BEFORE_NAMESPACE();
namespace vestige {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<float, 16>;
using V = hn::Vec<D>;

constexpr float kTiny = 0x1p-120F;

void find_bounds(const MeshletCorners& corners, const glm::vec3& point, StartBounds::Numbers& out) {
  const D d;
  for (std::size_t i = 0; i < kMeshletTriangles; i += hn::Lanes(d)) {
    V to_box = hn::Zero(d);
    std::array<V, 3> to_corner = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    for (int axis = 0; axis < 3; ++axis) {
      const V place = hn::Set(d, point[axis]);
      const auto& of_corners = corners.position[static_cast<std::size_t>(axis)];
      std::array<V, 3> away = {};
      for (std::size_t k = 0; k < 3; ++k) {
        away[k] = hn::Sub(hn::Load(d, &of_corners[k][i]), place);
        to_corner[k] = hn::Add(to_corner[k], hn::Mul(away[k], away[k]));
      }
      const V least = hn::Min(hn::Min(away[0], away[1]), away[2]);
      const V most = hn::Max(hn::Max(away[0], away[1]), away[2]);
      const V gap = hn::Max(hn::Max(least, hn::Neg(most)), hn::Zero(d));
      to_box = hn::Add(to_box, hn::Mul(gap, gap));
    }
    const V nearest = hn::Min(hn::Min(to_corner[0], to_corner[1]), to_corner[2]);
    hn::Store(hn::Sub(hn::Mul(to_box, hn::Set(d, 1 - 0x1p-20F)), hn::Set(d, kTiny)), d, &out.at_least[i]);
    hn::Store(hn::Add(hn::Mul(nearest, hn::Set(d, 1 + 0x1p-20F)), hn::Set(d, kTiny)), d, &out.to_a_corner_at_most[i]);
  }
}

void compare_bounds(const StartBounds::Numbers& bounds, float limit, float radius_low, float radius_high,
                    StartMasks& out) {
  const D d;
  // An infinite bound says nothing: the sum may be too large for fp32 alone.
  const V most = hn::Set(d, std::numeric_limits<float>::max());
  for (std::size_t i = 0; i < kMeshletTriangles; i += hn::Lanes(d)) {
    const V at_least = hn::Load(d, &bounds.at_least[i]);
    const auto is_finite = hn::Le(at_least, most);
    out.farther |= mask_bits(d, hn::And(hn::Gt(at_least, hn::Set(d, limit)), is_finite)) << i;
    out.apart |= mask_bits(d, hn::And(hn::Gt(at_least, hn::Set(d, radius_high)), is_finite)) << i;
    out.corner_within |= mask_bits(d, hn::Le(hn::Load(d, &bounds.to_a_corner_at_most[i]), hn::Set(d, radius_low))) << i;
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace vestige
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vestige {

namespace {

HWY_EXPORT(find_bounds);
HWY_EXPORT(compare_bounds);

constexpr double kMost = std::numeric_limits<float>::max();

/// Squares in fp32, off by far more than their rounding.
float squared_at_most(double length) {
  const double squared = length * length * (1 + 0x1p-20);
  if (!(squared < kMost)) return std::numeric_limits<float>::infinity();
  return static_cast<float>(squared) + std::numeric_limits<float>::denorm_min();
}
float squared_at_least(double length) {
  const double squared = std::min(length * length * (1 - 0x1p-20), kMost);
  return static_cast<float>(squared) - std::numeric_limits<float>::denorm_min();
}

}  // namespace

void StartBounds::find(const MeshletCorners& corners, const glm::vec3& point) {
  HWY_DYNAMIC_DISPATCH(find_bounds)(corners, point, squared_m2_);
}

StartMasks StartBounds::compare(double limit, double radius) const {
  StartMasks masks;
  HWY_DYNAMIC_DISPATCH(compare_bounds)
  (squared_m2_, squared_at_most(limit), squared_at_least(radius), squared_at_most(radius), masks);
  return masks;
}

std::size_t StartBounds::nearest(std::uint32_t bits) const {
  auto nearest = static_cast<std::size_t>(std::countr_zero(bits));
  for (bits &= bits - 1; bits != 0; bits &= bits - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(bits));
    if (squared_m2_.at_least[i] < squared_m2_.at_least[nearest]) nearest = i;
  }
  return nearest;
}

}  // namespace vestige
#endif
