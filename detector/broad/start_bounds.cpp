#include "detector/broad/start_bounds.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detector/broad/start_bounds.cpp"  // NOLINT(bugprone-suspicious-include)
#include <hwy/foreach_target.h>
// After foreach_target.h, which includes this file once for each instruction set.
#include <hwy/highway.h>

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

void find_bounds(const MeshletCorners& corners, const glm::vec3& point, StartBounds& out) {
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

}  // namespace HWY_NAMESPACE
}  // namespace vestige
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vestige {

namespace {

HWY_EXPORT(find_bounds);

}  // namespace

void find_start_bounds(const MeshletCorners& corners, const glm::vec3& point, StartBounds& out) {
  HWY_DYNAMIC_DISPATCH(find_bounds)(corners, point, out);
}

}  // namespace vestige
#endif
