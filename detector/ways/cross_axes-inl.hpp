// This file is included once for each instruction set, after hwy/highway.h. So the include guard follows Highway's
// pattern.
#if defined(VESTIGE_CROSS_AXES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef VESTIGE_CROSS_AXES_INL
#undef VESTIGE_CROSS_AXES_INL
#else
#define VESTIGE_CROSS_AXES_INL
#endif

#include <array>
#include <cstddef>

// Along way x e_i, the box's centre c and half extent h lie at c_j way_k - c_k way_j, +- h_j |way_k| + h_k |way_j|. Let
// u = 2^-24, and M the larger magnitude of an end. The centre errs by u M, the half extent by 2 u M, and the products
// and sums by at most 4 u (M_j |way_k| + M_k |way_j|) and 4 u of `moment` and `spare`, for which `spare` has room. The
// half extent grows by 64 u M. Where an end is infinite, the centre or the half extent is infinite or not a number, and
// proves nothing. Products below 2^-126 may be lost; `spare` has room for that, too.
HWY_BEFORE_NAMESPACE();
namespace vestige {
namespace HWY_NAMESPACE {

/// Three numbers of each lane, or of one thing in all lanes.
template <typename D>
using Triple = std::array<hwy::HWY_NAMESPACE::Vec<D>, 3>;

/// CrossAxes, in all lanes or one a lane.
template <typename D>
struct AxesLanes {
  Triple<D> way;
  Triple<D> moment;
  Triple<D> spare;
};

/// Likewise boxes.
template <typename D>
struct BoxLanes {
  Triple<D> centre;
  Triple<D> half;
};

template <typename D>
inline BoxLanes<D> box_lanes(D d, const Triple<D>& low, const Triple<D>& high) {
  namespace hn = hwy::HWY_NAMESPACE;
  BoxLanes<D> box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto largest = hn::Max(hn::Abs(low[axis]), hn::Abs(high[axis]));
    box.centre[axis] = hn::Mul(hn::Add(low[axis], high[axis]), hn::Set(d, 0.5F));
    box.half[axis] =
        hn::Add(hn::Mul(hn::Sub(high[axis], low[axis]), hn::Set(d, 0.5F)), hn::Mul(largest, hn::Set(d, 0x1p-18F)));
  }
  return box;
}

/// Whether one of the directions separates box and cut segment.
template <typename D>
inline hwy::HWY_NAMESPACE::Mask<D> are_beside(D d, const BoxLanes<D>& box, const AxesLanes<D>& axes) {
  namespace hn = hwy::HWY_NAMESPACE;
  auto beside = hn::FirstN(d, 0);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t j = (axis + 1) % 3;
    const std::size_t k = (axis + 2) % 3;
    const auto along = hn::Sub(hn::Mul(box.centre[j], axes.way[k]), hn::Mul(box.centre[k], axes.way[j]));
    const auto reach = hn::Add(hn::Mul(box.half[j], hn::Abs(axes.way[k])), hn::Mul(box.half[k], hn::Abs(axes.way[j])));
    const auto away = hn::Abs(hn::Sub(along, axes.moment[axis]));
    beside = hn::Or(beside, hn::Gt(away, hn::Add(reach, axes.spare[axis])));
  }
  return beside;
}

}  // namespace HWY_NAMESPACE
}  // namespace vestige
HWY_AFTER_NAMESPACE();

#endif
