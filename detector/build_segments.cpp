#include "detector/build_segments.hpp"

#include <array>
#include <cstddef>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detector/build_segments.cpp"  // NOLINT(bugprone-suspicious-include)
#include <hwy/foreach_target.h>
// After foreach_target.h, which includes this file once for each instruction set.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace vestige {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<double, 4>;

/// Within this range, a segment's end that is carried with the skin stays in that of fp32.
constexpr float kLargestCollider_m = std::numeric_limits<float>::max() / 2;

// A place and the number behind it in memory are taken together: behind a start lies the end's x, and behind an end the
// radius. What becomes of that number is either overwritten or wanted.
static_assert(offsetof(ColliderMove, end_m) == offsetof(ColliderMove, start_m) + 3 * sizeof(double));
static_assert(offsetof(ColliderMove, radius_m) == offsetof(ColliderMove, end_m) + 3 * sizeof(double));
static_assert(offsetof(Segment, end) == offsetof(Segment, start) + 3 * sizeof(float));
static_assert(offsetof(Segment, radius_m) == offsetof(Segment, end) + 3 * sizeof(float));

SegmentCounts make_segments(std::span<const ColliderMove> moves, const SegmentPlace& place, std::vector<Segment>& out) {
  const D d;
  const hn::Rebind<float, D> as_float;
  alignas(32) const std::array<double, 4> origin_m = {place.origin_m.x, place.origin_m.y, place.origin_m.z, 0};
  constexpr float kAny = std::numeric_limits<float>::infinity();
  alignas(16) const std::array<float, 4> reach_m = {place.reach_m.x, place.reach_m.y, place.reach_m.z, kAny};
  alignas(16) constexpr std::array<float, 4> kRange_m = {kLargestCollider_m, kLargestCollider_m, kLargestCollider_m,
                                                         kAny};
  alignas(16) const std::array<float, 4> long_m = {place.long_m, place.long_m, place.long_m, kAny};
  SegmentCounts counts;
  out.resize(moves.size());
  std::size_t count = 0;
  for (const ColliderMove& move : moves) {
    if (move.owner == place.left_owner) continue;
    bool in_range = true;
    bool is_beyond = false;
    bool is_long = false;
    Segment& segment = out[count];
    const auto radius = hn::Set(as_float, bounding_radius_m(static_cast<float>(move.radius_m)));
    // From the back, so that the end's x comes after what is stored behind the start.
    for (std::size_t i = 4; i > 0;) {
      i -= hn::Lanes(d);
      const auto origin = hn::Load(d, &origin_m[i]);
      const auto start = hn::DemoteTo(as_float, hn::Sub(hn::LoadU(d, &move.start_m.x + i), origin));
      const auto end = hn::DemoteTo(as_float, hn::Sub(hn::LoadU(d, &move.end_m.x + i), origin));
      const auto range = hn::Load(as_float, &kRange_m[i]);
      const auto within = hn::And(hn::Lt(hn::Abs(start), range), hn::Lt(hn::Abs(end), range));
      in_range = in_range && hn::AllTrue(as_float, within);
      const auto reach = hn::Add(hn::Load(as_float, &reach_m[i]), radius);
      const auto above = hn::Gt(hn::Min(start, end), reach);
      const auto below = hn::Lt(hn::Max(start, end), hn::Neg(reach));
      is_beyond = is_beyond || !hn::AllFalse(as_float, hn::Or(above, below));
      const auto way = hn::Abs(hn::Sub(end, start));
      is_long = is_long || !hn::AllFalse(as_float, hn::Gt(way, hn::Load(as_float, &long_m[i])));
      hn::StoreU(start, as_float, &segment.start.x + i);
      hn::StoreU(end, as_float, &segment.end.x + i);
    }
    segment.column = move.column;
    counts.out_of_range += in_range ? 0U : 1U;
    counts.out_of_reach += in_range && is_beyond ? 1U : 0U;
    counts.long_segments += in_range && !is_beyond && is_long ? 1U : 0U;
    count += in_range && !is_beyond ? 1U : 0U;  // without a branch, which nobody could foretell
  }
  out.resize(count);
  return counts;
}

}  // namespace HWY_NAMESPACE
}  // namespace vestige
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vestige {

namespace {

HWY_EXPORT(make_segments);

}  // namespace

SegmentCounts build_segments(std::span<const ColliderMove> moves, const SegmentPlace& place,
                             std::vector<Segment>& out) {
  return HWY_DYNAMIC_DISPATCH(make_segments)(moves, place, out);
}

}  // namespace vestige
#endif
