#include "detector/coherence/gap_kernels.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detector/coherence/gap_kernels.cpp"  // NOLINT(bugprone-suspicious-include)
#include <hwy/foreach_target.h>
// After foreach_target.h, which includes this file once for each instruction set.
#include <hwy/highway.h>

#include "detector/broad/mask_bits-inl.hpp"

// A gap is the distance from a point to a box. Along each axis it is the larger of low - x and x - high, or 0; then the
// root of the sum of squares. Subtractions, squares, sums and the root each err by at most u = 2^-24 of the result:
// kDown takes 16 u away. A square below 2^-126 may be lost, which makes the gap smaller. Where something is not a
// number, the gap is 0. Growing a box rounds by u of its place, for which the margin of its making has room.
HWY_BEFORE_NAMESPACE();
namespace vestige {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr float kDown = 1 - 0x1p-20F;
/// No larger gap is kept, and no larger margin asked for: so it is never proven where that is not enough.
constexpr float kMost_m = kLargestGap_m;

template <typename D>
struct Compared {
  hn::Mask<D> apart;
  hn::Vec<D> gap_m;
};

/// Compares the collider with Lanes(d) boxes from the `i`th on.
template <typename D, std::size_t kCount>
inline Compared<D> compare(D d, const BoxList<kCount>& boxes, std::size_t i, hn::Vec<D> grown, const GapQuery& query) {
  auto apart = hn::FirstN(d, 0);
  const auto along = [&](std::size_t axis) {
    const int a = static_cast<int>(axis);
    const auto low = hn::Sub(hn::Load(d, &boxes.low[axis][i]), grown);
    const auto high = hn::Add(hn::Load(d, &boxes.high[axis][i]), grown);
    apart = hn::Or(apart, hn::Gt(low, hn::Set(d, query.box.high[a])));
    apart = hn::Or(apart, hn::Lt(high, hn::Set(d, query.box.low[a])));
    const auto at = hn::Set(d, query.end[a]);
    const auto away = hn::Max(hn::Max(hn::Sub(low, at), hn::Sub(at, high)), hn::Zero(d));
    return hn::Mul(away, away);
  };
  const auto x = along(0);
  const auto y = along(1);
  const auto z = along(2);
  auto gap = hn::Mul(hn::Sqrt(hn::Add(hn::Add(x, y), z)), hn::Set(d, kDown));
  gap = hn::IfThenElseZero(hn::Eq(gap, gap), gap);
  return {apart, hn::Min(gap, hn::Set(d, kMost_m))};
}

std::size_t follow(const PartList& parts, std::span<const Segment> segments, std::uint64_t index, float reserve_m,
                   const Known& known, Due* out) {
  const hn::CappedTag<std::int32_t, kPartBlock> d;
  const std::size_t count = parts.count;
  std::size_t due = 0;
  for (std::size_t number = 0; number < segments.size(); ++number) {
    const Segment& segment = segments[number];
    Follower& follower = known.followers[segment.column];
    std::int32_t* const to_parts = known.distances + segment.column * count;
    const glm::vec3 way = segment.end - segment.start;
    const float way_m = std::sqrt(way.x * way.x + way.y * way.y + way.z * way.z) * kGapUp + 0x1p-62F;
    const bool follows = follower.seen == index && segment.start == follower.end && way_m < kFarthest_m;
    follower.end = segment.end;
    follower.seen = index + 1;
    if (follows) {
      follower.own_clock += units_up(way_m);
    } else {
      follower.own_clock = 0;
      std::copy_n(parts.clock.begin(), count, to_parts);
    }
    const float margin_m = std::min(bounding_radius_m(segment) + reserve_m, kMost_m);
    const auto passed = hn::Set(d, follower.own_clock + units_up(margin_m));
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
      const auto left = hn::Sub(hn::Load(d, to_parts + i), hn::Load(d, &parts.clock[i]));
      bits |= std::uint64_t{mask_bits(d, hn::Not(hn::Gt(left, passed)))} << i;
    }
    bits &= parts.existing;
    out[due].segment = static_cast<std::uint32_t>(number);
    out[due].way_m = way_m;
    out[due].parts = bits;
    due += bits != 0 ? 1U : 0U;  // without a branch, which nobody could foretell
  }
  return due;
}

void near_parts(const PartList& parts, std::span<const Due> due, std::span<const GapQuery> queries, float frames,
                std::int32_t* distances, std::vector<NodePair>& out) {
  const hn::CappedTag<float, kPartBlock> d;
  const hn::RebindToSigned<decltype(d)> di;
  for (std::size_t k = 0; k < due.size(); ++k) {
    const GapQuery& query = queries[k];
    std::int32_t* const to_parts = distances + query.column * parts.count;
    const auto own = hn::Set(di, query.own_clock);
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < parts.count; i += hn::Lanes(d)) {
      const auto [apart, gap] = compare(d, parts.boxes, i, hn::Load(d, &parts.grown_m[i]), query);
      const auto spent_m = hn::Add(hn::Load(d, &parts.step_m[i]), hn::Set(d, query.reach_m));
      const auto far = hn::And(apart, hn::Gt(gap, hn::Mul(spent_m, hn::Set(d, frames))));
      bits |= std::uint64_t{mask_bits(d, hn::Not(far))} << i;
      const auto units = hn::ConvertTo(di, hn::Mul(gap, hn::Set(d, 1 / kGapUnit_m)));
      const auto distance = hn::Add(units, hn::Add(hn::Load(di, &parts.clock[i]), own));
      hn::Store(hn::Max(hn::Load(di, to_parts + i), distance), di, to_parts + i);
    }
    for (bits &= due[k].parts; bits != 0; bits &= bits - 1) {
      NodePair& pair = out.emplace_back();
      pair.due = static_cast<std::uint32_t>(k);
      pair.node = static_cast<std::uint32_t>(std::countr_zero(bits));
      pair.root = static_cast<std::uint32_t>(out.size() - 1);
    }
  }
}

void near_children(std::span<const NodePair> pairs, const NodeBoxes* const* boxes, std::span<const GapQuery> queries,
                   const float* near_m, float* least_m, std::vector<NearChild>& out) {
  const hn::CappedTag<float, kMeshletFanout> d;
  alignas(32) std::array<float, kMeshletFanout> gaps;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const GapQuery& query = queries[pairs[k].due];
    const auto grown = hn::Set(d, boxes[k]->grown_m);
    auto least = hn::Set(d, kMost_m);
    std::uint32_t meets = 0;
    std::uint32_t near = 0;
    for (std::size_t i = 0; i < kMeshletFanout; i += hn::Lanes(d)) {
      const auto [apart, gap] = compare(d, boxes[k]->children, i, grown, query);
      const auto far = hn::And(apart, hn::Gt(gap, hn::Set(d, near_m[k])));
      hn::Store(gap, d, &gaps[i]);
      least = hn::Min(least, hn::IfThenElse(far, gap, least));
      meets |= mask_bits(d, hn::Not(apart)) << i;
      near |= mask_bits(d, hn::Not(far)) << i;
    }
    float& of_root = least_m[pairs[k].root];
    of_root = std::min(of_root, hn::GetLane(hn::MinOfLanes(d, least)));
    for (near &= boxes[k]->existing; near != 0; near &= near - 1) {
      const auto child = static_cast<std::uint32_t>(std::countr_zero(near));
      NearChild& found = out.emplace_back();
      found.pair = static_cast<std::uint32_t>(k);
      found.child = pairs[k].node * static_cast<std::uint32_t>(kMeshletFanout) + child;
      found.may_meet = (meets >> child & 1U) != 0;
      found.gap_m = gaps[child];
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace vestige
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vestige {

HWY_EXPORT(follow);
HWY_EXPORT(near_parts);
HWY_EXPORT(near_children);

std::size_t follow_segments(const PartList& parts, std::span<const Segment> segments, std::uint64_t index,
                            float reserve_m, const Known& known, Due* out) {
  return HWY_DYNAMIC_DISPATCH(follow)(parts, segments, index, reserve_m, known, out);
}

void find_near_parts(const PartList& parts, std::span<const Due> due, std::span<const GapQuery> queries, float frames,
                     std::int32_t* distances, std::vector<NodePair>& out) {
  HWY_DYNAMIC_DISPATCH(near_parts)(parts, due, queries, frames, distances, out);
}

void find_near_children(std::span<const NodePair> pairs, const NodeBoxes* const* boxes,
                        std::span<const GapQuery> queries, const float* near_m, float* least_m,
                        std::vector<NearChild>& out) {
  HWY_DYNAMIC_DISPATCH(near_children)(pairs, boxes, queries, near_m, least_m, out);
}

}  // namespace vestige
#endif
