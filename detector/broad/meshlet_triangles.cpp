#include "detector/broad/meshlet_triangles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detector/broad/meshlet_triangles.cpp"  // NOLINT(bugprone-suspicious-include)
#include <hwy/foreach_target.h>
// After foreach_target.h, which includes this file once for each instruction set.
#include <hwy/highway.h>

#include "detector/broad/mask_bits-inl.hpp"
#include "detector/ways/cross_axes-inl.hpp"

// Boxes. Those of `static` and `ccd` are not rounded. For `carried`, the displacement m moves a start, which is then
// rounded to fp32. The moved start is at or above `low` only if the start was at or above low - m. Let M be the largest
// magnitude of the six coordinates, and u = 2^-24. m is computed here in fp32 and errs by less than 10 u M (differences
// of at most 2 M, their sums, a third). Near the box, rounding the moved start errs by at most 2 u M. The subtractions
// here err by 6 u M. The margin is 64 u M, and 2^-120 for underflow.
//
// Slabs. Take any axis n, and the segment's ends relative to the triangle's corners at the time of each end. If all lie
// on one side along n, the segment misses the triangle (the separating axis theorem; for `ccd` as in
// shaders/geometry.geom). n need not be accurate, but it must be the same for all. The computed n . x errs by at most 4
// u |n| . |x| (Higham, Accuracy and Stability of Numerical Algorithms, 2nd ed., 3.1). For `carried`, n . (x + m) of the
// start is compared as n . x with a slab moved by -n . m. Four errors add up: those of m above; that of the product, 6
// u |n| . M; that of the subtraction, 3 u |n| . M; and that of rounding the start, u |n| . (|x| + 2 M). Together that
// is less than 32 u |n| . M on the slab's side, and 8 u |n| . |x| on the segment's side. Each side gets 64 u, which
// also covers its own rounding, and 2^-120 for underflow. A margin that overflows is infinite or not a number, and then
// proves nothing.
//
// Spheres. A sphere of radius r misses if its centre is more than r away from the slab: the same comparison with r |n|
// more on the segment's side. r is taken 2^-20 larger, which covers the rounding of |n| and of the product.
//
// Cut segments. The two slabs are those at the times of the segment's own ends, between which it changes linearly. A
// cut segment's ends are at any times, so both are compared with the slab that contains the two.
HWY_BEFORE_NAMESPACE();
namespace vestige {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<float, 16>;
using V = hn::Vec<D>;

constexpr float kMargin = 0x1p-18F;  // 64 u
constexpr float kTiny = 0x1p-120F;

struct Vector {
  V x;
  V y;
  V z;
};

inline Vector corner_of(const MeshletCorners& corners, std::size_t corner, std::size_t i) {
  const D d;
  return {hn::Load(d, &corners.position[0][corner][i]), hn::Load(d, &corners.position[1][corner][i]),
          hn::Load(d, &corners.position[2][corner][i])};
}
inline void store(const Vector& v, std::array<MeshletTriangles::Numbers, 3>& out, std::size_t i) {
  const D d;
  hn::Store(v.x, d, &out[0][i]);
  hn::Store(v.y, d, &out[1][i]);
  hn::Store(v.z, d, &out[2][i]);
}

inline Vector operator+(const Vector& a, const Vector& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
inline Vector operator-(const Vector& a, const Vector& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
inline Vector operator*(const Vector& a, float factor) {
  const auto f = hn::Set(D(), factor);
  return {hn::Mul(a.x, f), hn::Mul(a.y, f), hn::Mul(a.z, f)};
}
inline Vector least(const Vector& a, const Vector& b) {
  return {hn::Min(a.x, b.x), hn::Min(a.y, b.y), hn::Min(a.z, b.z)};
}
inline Vector greatest(const Vector& a, const Vector& b) {
  return {hn::Max(a.x, b.x), hn::Max(a.y, b.y), hn::Max(a.z, b.z)};
}
inline Vector magnitude(const Vector& a) {
  return {hn::Abs(a.x), hn::Abs(a.y), hn::Abs(a.z)};
}
inline Vector everywhere(const glm::vec3& v) {
  const D d;
  return {hn::Set(d, v.x), hn::Set(d, v.y), hn::Set(d, v.z)};
}
inline V dot(const Vector& a, const Vector& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
inline Vector cross(const Vector& a, const Vector& b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)), hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}
/// Returns 64 u of `size`, plus the margin for underflow.
inline V margin_of(V size) {
  const D d;
  return hn::Add(hn::Mul(size, hn::Set(d, kMargin)), hn::Set(d, kTiny));
}
inline Vector margin_of(const Vector& size) {
  return {margin_of(size.x), margin_of(size.y), margin_of(size.z)};
}

/// Returns at least how far a sphere reaches along `normal`, from its centre. Squares below 2^-126 may be lost, so less
/// than 2^-62 of the normal's length.
inline V reach_along(const Vector& normal, const Segment& sphere) {
  const D d;
  const V length = hn::Add(hn::Sqrt(dot(normal, normal)), hn::Set(d, 0x1p-62F));
  return hn::Mul(length, hn::Set(d, bounding_radius_m(sphere)));
}

void bound_triangles(const MeshletCorners& now, const MeshletCorners& before, Method method,
                     MeshletTriangles::Bounds& out) {
  const D d;
  for (std::size_t i = 0; i < kMeshletTriangles; i += hn::Lanes(d)) {
    const Vector a = corner_of(now, 0, i);
    const Vector b = corner_of(now, 1, i);
    const Vector c = corner_of(now, 2, i);
    Vector low = least(least(a, b), c);
    Vector high = greatest(greatest(a, b), c);
    const Vector normal = cross(b - a, c - a);
    const V along_a = dot(normal, a);
    const V along_b = dot(normal, b);
    const V along_c = dot(normal, c);
    V slab_low_end = hn::Min(hn::Min(along_a, along_b), along_c);
    V slab_high_end = hn::Max(hn::Max(along_a, along_b), along_c);
    V slab_low_start = slab_low_end;
    V slab_high_start = slab_high_end;
    Vector largest = greatest(magnitude(low), magnitude(high));
    if (method != Method::kStatic) {
      const Vector a_before = corner_of(before, 0, i);
      const Vector b_before = corner_of(before, 1, i);
      const Vector c_before = corner_of(before, 2, i);
      const Vector low_before = least(least(a_before, b_before), c_before);
      const Vector high_before = greatest(greatest(a_before, b_before), c_before);
      largest = greatest(largest, greatest(magnitude(low_before), magnitude(high_before)));
      if (method == Method::kCcd) {
        low = least(low, low_before);
        high = greatest(high, high_before);
        const V before_a = dot(normal, a_before);
        const V before_b = dot(normal, b_before);
        const V before_c = dot(normal, c_before);
        slab_low_start = hn::Min(hn::Min(before_a, before_b), before_c);
        slab_high_start = hn::Max(hn::Max(before_a, before_b), before_c);
      } else {
        largest = greatest(largest, everywhere(glm::vec3(0x1p-90F)));  // the start's rounding may be denormal
        const Vector moved = ((a - a_before) + (b - b_before) + (c - c_before)) * (1.0F / 3.0F);
        const Vector nothing = everywhere(glm::vec3(0));
        const Vector margin = margin_of(largest);
        low = low - greatest(moved, nothing) - margin;
        high = high - least(moved, nothing) + margin;
        const V along_moved = dot(normal, moved);
        slab_low_start = hn::Sub(slab_low_start, along_moved);
        slab_high_start = hn::Sub(slab_high_start, along_moved);
      }
    }
    // For `carried`, the margin is computed from a larger value than any that is added above. So if one of those
    // overflows, the margin overflows too.
    const V margin = margin_of(dot(magnitude(normal), method == Method::kCarried ? largest * 4.0F : largest));
    store(low, out.low, i);
    store(high, out.high, i);
    store(normal, out.normal, i);
    hn::Store(hn::Sub(slab_low_start, margin), d, &out.slab_low[0][i]);
    hn::Store(hn::Add(slab_high_start, margin), d, &out.slab_high[0][i]);
    hn::Store(hn::Sub(slab_low_end, margin), d, &out.slab_low[1][i]);
    hn::Store(hn::Add(slab_high_end, margin), d, &out.slab_high[1][i]);
  }
}

/// Returns the axes in all lanes.
inline AxesLanes<D> everywhere(const CrossAxes& axes) {
  const auto three = [](const glm::vec3& v) -> Triple<D> {
    const Vector all = everywhere(v);
    return {all.x, all.y, all.z};
  };
  return {three(axes.way), three(axes.moment), three(axes.spare)};
}

/// A segment that is whole, in the forms that are compared.
struct WholeSegment {
  const Segment& segment;
  SegmentBox box;
};

/// A segment that is cut, likewise.
struct CutSegment {
  const Segment& segment;
  SegmentBox box;
  CrossAxes axes;
};

/// Returns a word whose bit k says whether triangle i + k may meet the segment.
template <typename Tested>
inline std::uint32_t meet_some(const MeshletTriangles::Bounds& bounds, const Tested& tested, std::size_t i) {
  constexpr bool kIsCut = std::is_same_v<Tested, CutSegment>;
  const D d;
  const auto number = [&](const MeshletTriangles::Numbers& numbers) { return hn::Load(d, &numbers[i]); };
  auto apart = hn::FirstN(d, 0);
  for (int axis = 0; axis < 3; ++axis) {
    const auto place = static_cast<std::size_t>(axis);
    apart = hn::Or(apart, hn::Gt(number(bounds.low[place]), hn::Set(d, tested.box.high[axis])));
    apart = hn::Or(apart, hn::Lt(number(bounds.high[place]), hn::Set(d, tested.box.low[axis])));
  }
  if constexpr (kIsCut) {
    const auto three = [&](const std::array<MeshletTriangles::Numbers, 3>& numbers) -> Triple<D> {
      return {number(numbers[0]), number(numbers[1]), number(numbers[2])};
    };
    const BoxLanes<D> boxes = box_lanes(d, three(bounds.low), three(bounds.high));
    apart = hn::Or(apart, are_beside(d, boxes, everywhere(tested.axes)));
  }
  auto meets = hn::Not(apart);
  if (hn::AllFalse(d, meets)) return 0;
  const Vector normal = {number(bounds.normal[0]), number(bounds.normal[1]), number(bounds.normal[2])};
  const Segment& segment = tested.segment;
  const Vector start = everywhere(segment.start);
  const Vector end = everywhere(segment.end);
  V margin = margin_of(dot(magnitude(normal), greatest(magnitude(start), magnitude(end))));
  if (segment.is_sphere()) margin = hn::Add(margin, reach_along(normal, segment));
  const V along_start = dot(normal, start);
  const V along_end = dot(normal, end);
  V low_start = number(bounds.slab_low[0]);
  V low_end = number(bounds.slab_low[1]);
  V high_start = number(bounds.slab_high[0]);
  V high_end = number(bounds.slab_high[1]);
  if constexpr (kIsCut) {
    low_start = low_end = hn::Min(low_start, low_end);
    high_start = high_end = hn::Max(high_start, high_end);
  }
  const auto above =
      hn::And(hn::Gt(hn::Sub(along_start, margin), high_start), hn::Gt(hn::Sub(along_end, margin), high_end));
  const auto below =
      hn::And(hn::Lt(hn::Add(along_start, margin), low_start), hn::Lt(hn::Add(along_end, margin), low_end));
  meets = hn::AndNot(hn::Or(above, below), meets);
  return mask_bits(d, meets);
}

template <typename Tested>
inline std::uint32_t meet_all(const MeshletTriangles::Bounds& bounds, const Tested& tested) {
  std::uint32_t meets = 0;
  for (std::size_t i = 0; i < kMeshletTriangles; i += hn::Lanes(D())) meets |= meet_some(bounds, tested, i) << i;
  return meets;
}

void meet_triangles(const MeshletTriangles::Bounds& bounds, const Ways& ways, std::span<const std::uint32_t> numbers,
                    std::uint32_t* meets) {
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    const Segment& segment = ways.segments[numbers[k]];
    meets[k] = ways.is_cut(numbers[k]) ? meet_all(bounds, CutSegment{segment, box_of(segment), cross_axes(segment)})
                                       : meet_all(bounds, WholeSegment{segment, box_of(segment)});
  }
}

/// Of each triangle, the farther of its box and its slab. A square below 2^-126 may be lost, which makes a gap smaller;
/// the divisor is made larger by as much.
inline float gap_to_triangles(const MeshletTriangles::Bounds& bounds, const glm::vec3& point) {
  const D d;
  const auto zero = hn::Zero(d);
  const Vector at = everywhere(point);
  const auto away = [&](V low, V high, V x) { return hn::Max(hn::Max(hn::Sub(low, x), hn::Sub(x, high)), zero); };
  auto least = hn::Set(d, std::numeric_limits<float>::max());
  for (std::size_t i = 0; i < kMeshletTriangles; i += hn::Lanes(d)) {
    const auto number = [&](const MeshletTriangles::Numbers& numbers) { return hn::Load(d, &numbers[i]); };
    const Vector box = {away(number(bounds.low[0]), number(bounds.high[0]), at.x),
                        away(number(bounds.low[1]), number(bounds.high[1]), at.y),
                        away(number(bounds.low[2]), number(bounds.high[2]), at.z)};
    const V box2 = dot(box, box);
    const Vector normal = {number(bounds.normal[0]), number(bounds.normal[1]), number(bounds.normal[2])};
    const V along = dot(normal, at);
    const V margin = margin_of(dot(magnitude(normal), magnitude(at)));
    const V beside =
        hn::Max(hn::Sub(away(number(bounds.slab_low[1]), number(bounds.slab_high[1]), along), margin), zero);
    const V slab2 = hn::Div(hn::Mul(beside, beside), hn::Add(dot(normal, normal), hn::Set(d, 0x1p-100F)));
    const V farther = hn::IfThenElse(hn::Gt(slab2, box2), slab2, box2);
    least = hn::Min(least, hn::IfThenElseZero(hn::Eq(farther, farther), farther));
  }
  return hn::GetLane(hn::Mul(hn::Sqrt(hn::MinOfLanes(d, least)), hn::Set(d, 1 - 0x1p-18F)));
}

void triangle_gaps(std::span<TriangleGap> gaps) {
  for (TriangleGap& gap : gaps) gap.gap_m = gap_to_triangles(*gap.bounds, gap.point);
}

}  // namespace HWY_NAMESPACE
}  // namespace vestige
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vestige {

namespace {

HWY_EXPORT(bound_triangles);
HWY_EXPORT(meet_triangles);
HWY_EXPORT(triangle_gaps);

}  // namespace

void MeshletTriangles::bound(const MeshletCorners& now, const MeshletCorners& before, Method method) {
  HWY_DYNAMIC_DISPATCH(bound_triangles)(now, before, method, bounds_);
}

void MeshletTriangles::meet(const Ways& ways, std::span<const std::uint32_t> numbers, std::uint32_t* meets) const {
  HWY_DYNAMIC_DISPATCH(meet_triangles)(bounds_, ways, numbers, meets);
}

void find_triangle_gaps(std::span<TriangleGap> gaps) {
  HWY_DYNAMIC_DISPATCH(triangle_gaps)(gaps);
}

}  // namespace vestige
#endif
